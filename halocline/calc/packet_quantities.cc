// SPDX-License-Identifier: BSD-3-Clause
// Quantities of packets: bit and packet errors, codes, durations, Doppler.
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "acoustics/link/ray_doppler.h"
#include "acoustics/modem/bit_error.h"
#include "acoustics/modem/convolutional_code.h"
#include "acoustics/modem/modem.h"
#include "channel_server/modems/modem_config.h"
#include "core/check.h"
#include "core/sim_time.h"
#include "core/units.h"
#include "halocline/calc/columns.h"
#include "halocline/calc/quantity.h"

namespace halocline::clients {
namespace {

using acoustics::Decision;
using acoustics::Fading;
using acoustics::Modem;
using acoustics::Modulation;

InputColumn level_column(const std::string& name) { return {{name}, -200, 200, {}}; }

std::vector<double> bit_error_row(const std::vector<double>& v) {
  const PowerRatio ratio = to_power_ratio(Decibels{v[0]});
  const auto error = [&](Modulation m, Fading f) { return bit_error_rate(m, f, ratio); };
  const double bpsk = error(Modulation::kBpsk, Fading::kNone),
               bfsk = error(Modulation::kNoncoherentBfsk, Fading::kNone),
               fading = error(Modulation::kNoncoherentBfsk, Fading::kRayleigh);
  std::vector<double> row{bpsk,
                          bfsk,
                          error(Modulation::kCoherentBfsk, Fading::kNone),
                          error(Modulation::kDbpsk, Fading::kNone),
                          error(Modulation::kBpsk, Fading::kRayleigh),
                          fading};
  for (const double of_bit : {bpsk, bfsk, fading}) {
    for (const int bits : {64, 256, 2048}) row.push_back(acoustics::packet_error_rate(of_bit, bits));
  }
  return row;
}

Quantity bit_error_rate() {
  return {"bit-error-rate",
          "errors of bits and of packets of 64, 256 and 2048 bits, without error correction",
          {plain("uncoded", {level_column("EbN0_dB")},
                 {"BER_BPSK", "BER_noncoh_BFSK", "BER_coh_BFSK", "BER_DBPSK", "BER_BPSK_Rayleigh",
                  "BER_noncoh_BFSK_Rayleigh", "PER_BPSK_64bit", "PER_BPSK_256bit", "PER_BPSK_2048bit",
                  "PER_ncBFSK_64bit", "PER_ncBFSK_256bit", "PER_ncBFSK_2048bit", "PER_ncBFSK_Rayleigh_64bit",
                  "PER_ncBFSK_Rayleigh_256bit", "PER_ncBFSK_Rayleigh_2048bit"},
                 bit_error_row)}};
}

constexpr int kMaxDistance = 40;  // path counts up to here are exact integers in a double

Quantity code_spectrum() {
  return {"code-spectrum",
          "distance spectrum of the convolutional code (753, 561)",
          {{"janus",
            {{{"d"}, 1, kMaxDistance, {}}},
            {"a_d_paths", "B_d_total_info_weight"},
            [](const CalcOptions&) -> RowFunction {
              const auto spectrum = distance_spectrum(acoustics::kJanusCode, kMaxDistance);
              return [spectrum](const std::vector<double>& v) {
                for (const acoustics::SpectrumTerm& term : spectrum) {
                  if (term.distance == v[0]) return std::vector{term.paths, term.information_ones};
                }
                return std::vector{0.0, 0.0};
              };
            }}}};
}

std::vector<double> coded_row(const std::vector<double>& v) {
  constexpr std::int64_t kBits = 64;
  const PowerRatio snr = to_power_ratio(Decibels{v[0]});
  std::vector<double> bounds, packets;
  const auto add = [&](Decision decision, Fading fading) {
    const auto& spectrum = acoustics::janus_spectrum();
    bounds.push_back(union_bound(spectrum, decision, fading, snr));
    packets.push_back(
        acoustics::packet_error_rate(coded_bit_error_rate(spectrum, decision, fading, snr), kBits));
  };
  add(Decision::kSoft, Fading::kRayleigh);
  add(Decision::kSoft, Fading::kNone);
  add(Decision::kHard, Fading::kNone);
  add(Decision::kHard, Fading::kRayleigh);
  bounds.insert(bounds.end(), packets.begin(), packets.end());
  return bounds;
}

Quantity coded_error_rate() {
  return {"coded-error-rate",
          "union bound of the convolutional code (753, 561) on FSK chips, and packets of 64 bits",
          {plain("janus", {level_column("chip_SNR_dB")},
                 {"Pb_union_soft_Rayleigh", "Pb_union_soft_AWGN_noncoh", "Pb_union_hard_AWGN",
                  "Pb_union_hard_Rayleigh", "PER64_soft_Rayleigh", "PER64_soft_AWGN", "PER64_hard_AWGN",
                  "PER64_hard_Rayleigh"},
                 coded_row)}};
}

std::size_t whole_bytes(double bytes) {
  require(bytes >= 0 && bytes == std::floor(bytes), "a payload is a whole number of bytes");
  return static_cast<std::size_t>(bytes);
}

// Computes the chips of a JANUS packet. `payload_bits` includes the 64 of the baseline packet, as in the
// reference; the rest is cargo.
std::vector<double> janus_row(const std::vector<double>& v) {
  const Modem modem = channel_server::load_modem("janus").modem;
  const double chips_a_second = 2 * modem.bit_rate_bps;
  const auto timing = packet_timing(modem, whole_bytes((v[0] - modem.layout.header_bits) / 8));
  return {modem.centre_frequency_hz,
          modem.bandwidth_hz,
          1 / chips_a_second,
          timing.preamble.seconds() * chips_a_second,
          (timing.duration - timing.preamble).seconds() * chips_a_second,
          timing.duration.seconds() * chips_a_second,
          timing.duration.seconds()};
}

std::vector<double> duration_row(const Modem& modem, double payload_bytes) {
  const auto timing = packet_timing(modem, whole_bytes(payload_bytes));
  return {timing.preamble.seconds(), timing.duration.seconds(), static_cast<double>(timing.information_bits)};
}

// Returns the form for the modem whose profile has that name or path.
QuantityForm duration_form(const std::string& profile) {
  return {profile,
          {{{"payload_bytes"}, 0, 32'768, {}}},
          {"preamble_s", "duration_s", "information_bits"},
          [profile](const CalcOptions&) -> RowFunction {
            const Modem modem = channel_server::load_modem(profile).modem;
            return [modem](const std::vector<double>& v) { return duration_row(modem, v[0]); };
          }};
}

QuantityForm generic_duration_form() {
  QuantityForm form = duration_form(channel_server::kGenericProfile);
  form.inputs.push_back({{"bit_rate_bps"}, 1e-3, 1e7, 80});
  form.inputs.push_back({{"packet_overhead_s"}, 0, 60, 0});
  form.prepare = [](const CalcOptions&) -> RowFunction {
    return [](const std::vector<double>& v) {
      Modem modem;
      modem.bit_rate_bps = v[1];
      modem.packet_overhead = SimDuration::from_seconds(v[2]);
      return duration_row(modem, v[0]);
    };
  };
  return form;
}

Quantity packet_duration() {
  std::vector<QuantityForm> forms{plain("janus", {{{"payload_bits"}, 64, 1e6, {}}},
                                        {"fc_Hz", "bandwidth_Hz", "chip_duration_s", "preamble_chips",
                                         "coded_chips", "total_chips", "duration_s"},
                                        janus_row),
                                  generic_duration_form()};
  for (const std::string& name : channel_server::built_in_modems()) {
    if (name != "janus" && name != channel_server::kGenericProfile) forms.push_back(duration_form(name));
  }
  return {"packet-duration", "how long a packet takes, by the modem's profile (name or file)",
          std::move(forms), duration_form};
}

// Computes the Doppler shift; columns: speed of the source toward the receiver, speed of the receiver away
// from the source, frequency, sound speed. To first order:
//   f_rx = f (1 + (v_tx - v_rx) / c)
std::vector<double> doppler_row(const std::vector<double>& v) {
  const double shift = acoustics::doppler_shift(v[0], v[3], v[1], v[3]);
  return {v[2] * acoustics::doppler_factor(v[0], v[3], v[1], v[3]), shift, v[2] * (1 + (v[0] - v[1]) / v[3])};
}

Quantity doppler() {
  return {"doppler",
          "frequency received from a source in motion, exact and to first order",
          {plain("exact",
                 {{{"v_tx_toward_rx_m_per_s"}, -1000, 1000, {}},
                  {{"v_rx_away_from_tx_m_per_s"}, -1000, 1000, {}},
                  {{"f_Hz"}, 1e-3, 1e9, {}},
                  {{"c_m_per_s"}, 1000, 2000, 1500}},
                 {"f_rx_exact_Hz", "relative_shift", "f_rx_first_order_Hz"}, doppler_row)}};
}

}  // namespace

std::vector<Quantity> packet_quantities() {
  return {bit_error_rate(), coded_error_rate(), code_spectrum(), packet_duration(), doppler()};
}

}  // namespace halocline::clients
