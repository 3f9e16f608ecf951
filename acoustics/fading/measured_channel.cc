// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/fading/measured_channel.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

#include "acoustics/math/functions.h"
#include "core/check.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

constexpr double kLobes = 16;                        // lobes of the sinc to either side
constexpr double kKeptPower = 0.999;                 // share of the mean power in the kept taps
constexpr double kFirstTapPower = 0.01;              // relative to the strongest tap: 20 dB below
constexpr double kSameFromInstantToInstant = 1e-12;  // 1 - |R1| / R0 of a tap that does not change

// The taps of the band at all instants; the first tap lies `first` samples from delay 0.
struct BandTable {
  std::ptrdiff_t first = 0;
  std::size_t taps = 0;
  std::vector<Complex> values;  // [instant * taps + tap]
};

// g_n = sum_k h_k exp(-j 2 pi (f0 - fc) tau_k) sinc(n - B tau_k), tau_k = k / fs_delay (measured_channel.h).
BandTable band_table(const ChannelRecord& record, const Band& band) {
  const double samples_per_delay = band.width_hz() / record.delay_rate_hz;
  const auto last = static_cast<std::ptrdiff_t>(
      std::ceil(static_cast<double>(record.delays - 1) * samples_per_delay + kLobes));
  BandTable table;
  table.first = -static_cast<std::ptrdiff_t>(kLobes);
  table.taps = static_cast<std::size_t>(last - table.first + 1);
  table.values.resize(record.instants() * table.taps);
  for (std::size_t k = 0; k < record.delays; ++k) {
    const double place = static_cast<double>(k) * samples_per_delay;
    const double cycles =
        (band.centre_hz() - record.carrier_hz) * static_cast<double>(k) / record.delay_rate_hz;
    const Complex turn = elementary::polar(1.0, -2 * pi * std::fmod(cycles, 1.0));
    const auto from = static_cast<std::ptrdiff_t>(std::ceil(place - kLobes));
    const auto to = static_cast<std::ptrdiff_t>(std::floor(place + kLobes));
    for (std::ptrdiff_t n = from; n <= to; ++n) {
      const Complex factor = turn * sinc(static_cast<double>(n) - place);
      if (std::norm(factor) < 1e-24) continue;  // rounding error at the sinc's zeros
      const auto tap = static_cast<std::size_t>(n - table.first);
      for (std::size_t i = 0; i < record.instants(); ++i) {
        table.values[i * table.taps + tap] += factor * Complex(record.taps[i * record.delays + k]);
      }
    }
  }
  return table;
}

// Statistics of tap `n` of the table. The caller sets its delay and adjusts its phase. Between the instants a
// and b the mean power of the linear interpolation is
//   (|a|^2 + |b|^2 + Re(a* b)) / 3,
// and the Doppler spread B solves |R1| / R0 = exp(-(2 pi B / fs_time)^2 / 2).
MeasuredTap statistics(const BandTable& table, std::size_t n, double time_rate_hz) {
  const std::size_t instants = table.values.size() / table.taps;
  const auto at = [&](std::size_t i) { return table.values[i * table.taps + n]; };
  Complex sum, next_product;
  // The mean power with that of the linear interpolation in between, and R0 without the step from the last to
  // the first instant.
  double between = 0, neighbours = 0;
  for (std::size_t i = 0; i < instants; ++i) {
    const Complex a = at(i), b = at((i + 1) % instants);
    sum += a;
    between += (std::norm(a) + std::norm(b) + (std::conj(a) * b).real()) / 3;
    if (i + 1 == instants) continue;
    next_product += std::conj(a) * b;
    neighbours += (std::norm(a) + std::norm(b)) / 2;
  }
  const auto count = static_cast<double>(instants);
  MeasuredTap tap;
  tap.power = between / count;
  if (!(tap.power > 0)) return tap;
  tap.coherent = std::min(std::norm(sum / count) / tap.power, 1.0);
  tap.phase_rad = elementary::arg(sum);
  const double correlation = elementary::hypot(next_product.real(), next_product.imag()) / neighbours;
  if (correlation < 1 - kSameFromInstantToInstant) {
    const double spread_hz = std::sqrt(-2 * elementary::log(correlation)) / (2 * pi) * time_rate_hz;
    tap.doppler_spread_hz = std::min(spread_hz, time_rate_hz / 2);
  }
  return tap;
}

// Indices of the taps to keep, rising.
std::vector<std::size_t> kept_taps(const std::vector<MeasuredTap>& all) {
  std::vector<std::size_t> by_power(all.size());
  std::iota(by_power.begin(), by_power.end(), std::size_t{0});
  std::stable_sort(by_power.begin(), by_power.end(),
                   [&](std::size_t a, std::size_t b) { return all[a].power > all[b].power; });
  double total = 0, held = 0;
  for (const MeasuredTap& tap : all) total += tap.power;
  std::vector<std::size_t> kept;
  for (const std::size_t n : by_power) {
    if (held >= kKeptPower * total) break;
    held += all[n].power;
    kept.push_back(n);
  }
  std::sort(kept.begin(), kept.end());
  const double least = kFirstTapPower * all[by_power.front()].power;
  const auto first =
      std::find_if(kept.begin(), kept.end(), [&](std::size_t n) { return all[n].power >= least; });
  kept.erase(kept.begin(), first);
  return kept;
}

}  // namespace

MeasuredChannel::MeasuredChannel(const ChannelRecord& record, const Band& band)
    : time_rate_hz_(record.time_rate_hz), instants_(record.instants()) {
  validate(record);
  require_holds(record, band, "a modem");
  const BandTable all = band_table(record, band);
  std::vector<MeasuredTap> every;
  for (std::size_t n = 0; n < all.taps; ++n) every.push_back(statistics(all, n, time_rate_hz_));
  const std::vector<std::size_t> kept = kept_taps(every);
  table_.resize(instants_ * kept.size());
  for (std::size_t p = 0; p < kept.size(); ++p) {
    MeasuredTap tap = every[kept[p]];
    tap.delay_s = static_cast<double>(kept[p] - kept.front()) / band.width_hz();
    // A path's response does not include exp(-j 2 pi f0 delay), but g does.
    const double cycles = std::fmod(band.centre_hz() * tap.delay_s, 1.0);
    const Complex turn = elementary::polar(1.0, 2 * pi * cycles);
    tap.phase_rad = std::remainder(tap.phase_rad + 2 * pi * cycles, 2 * pi);
    power_ += tap.power;
    taps_.push_back(tap);
    for (std::size_t i = 0; i < instants_; ++i) {
      table_[i * kept.size() + p] =
          static_cast<std::complex<float>>(turn * all.values[i * all.taps + kept[p]]);
    }
  }
}

std::vector<Complex> MeasuredChannel::values(double first_s, double step_s, std::size_t count) const {
  std::vector<Complex> all(taps_.size() * count);
  for (std::size_t i = 0; i < count; ++i) {
    const double turns = (first_s + step_s * static_cast<double>(i)) / duration_s();
    const double place = (turns - std::floor(turns)) * static_cast<double>(instants_);
    const std::size_t before = std::min(static_cast<std::size_t>(place), instants_ - 1);
    const double share = place - static_cast<double>(before);
    const std::complex<float>* a = &table_[before * taps_.size()];
    const std::complex<float>* b = &table_[(before + 1) % instants_ * taps_.size()];
    for (std::size_t p = 0; p < taps_.size(); ++p) {
      all[p * count + i] = (1 - share) * Complex(a[p]) + share * Complex(b[p]);
    }
  }
  return all;
}

}  // namespace halocline::acoustics
