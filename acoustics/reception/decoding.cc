#include "acoustics/reception/decoding.h"

#include <algorithm>

#include "core/elementary.h"
#include "core/units.h"

namespace halocline::acoustics {
double chip_energy(const Modem& modem) { return 0.5 * modem.bandwidth_hz / modem.bit_rate_bps; }

std::vector<std::int64_t> coded_blocks(const Modem& modem, std::int64_t information_bits) {
  std::vector<std::int64_t> blocks;
  const std::int64_t header = std::min<std::int64_t>(modem.layout.header_bits, information_bits);
  if (header > 0) blocks.push_back(header);
  std::int64_t left = information_bits - header;
  const std::int64_t frame = modem.layout.frame_bytes > 0 ? 8 * std::int64_t{modem.layout.frame_bytes} : left;
  for (; left > 0; left -= frame) blocks.push_back(std::min(frame, left));
  return blocks;
}

BlockDecoder::BlockDecoder(const Modem& modem, bool fades)
    : modem_(modem), interleaved_(fades && is_coded_frequency_shift_keying(modem.error_model)) {}

void BlockDecoder::add(double share, double sinr) {
  sum_ += share * (interleaved_ ? elementary::exp(-chip_energy(modem_) * sinr / kEffectiveRatioBeta)
                                : elementary::log1p(-bit_error_rate(modem_, PowerRatio{sinr})));
}

double BlockDecoder::success(std::int64_t bits) const {
  if (!interleaved_) return elementary::exp(static_cast<double>(bits) * sum_);
  // No ratio at all of cells that are loud throughout: there exp(-gamma / beta) is 0.
  const double effective = -kEffectiveRatioBeta * elementary::log(std::max(sum_, 1e-300));
  const double error = bit_error_rate(modem_, PowerRatio{effective / chip_energy(modem_)});
  return elementary::exp(static_cast<double>(bits) * elementary::log1p(-error));
}

}  // namespace halocline::acoustics
