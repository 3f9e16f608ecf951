// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/protocols/micromodem/micromodem_reports.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "core/elementary.h"

namespace halocline::modem_gateway {
namespace {

constexpr double kSoundSpeed_mps = 1500, kFullScale_db = 180, kFullScale = 32767;
constexpr std::array<MicromodemRate, kMicromodemRates> kRates{{{1, 32, 80, 4000},
                                                               {3, 64, 250, 5000},
                                                               {3, 64, 500, 5000},
                                                               {2, 256, 1200, 5000},
                                                               {2, 256, 1300, 5000},
                                                               {8, 256, 5300, 5000},
                                                               {6, 32, 500, 5000}}};
constexpr int kNewestTransmission = 7, kProbeLength = 200;

double ratio_of(double db) { return elementary::exp10(db / 10); }
double db_of(double ratio) { return 10 * elementary::log10(ratio); }

// Clock mode: bit 0, the clock was set; bit 1, it receives pulses.
int clock_mode(const ModemClock& clock) { return (clock.is_set() ? 1 : 0) + (clock.has_pps() ? 2 : 0); }

// Clock mode of a reception, as newer firmware has it. Bits 0 and 1: who set the clock (2: a user); bits 2 to
// 4: source of the pulses (3: external).
int clock_sources(const ModemClock& clock) {
  return (clock.is_set() ? 2 : 0) + (clock.has_pps() ? 3 << 2 : 0);
}

// Least mean square error of symbols of unit power, dB: MSE = 1 / (1 + SINR).
double mse_db(double sinr_db) { return -db_of(1 + ratio_of(sinr_db)); }

}  // namespace

const MicromodemRate& micromodem_rate(int rate) { return kRates.at(static_cast<std::size_t>(rate)); }

ReceptionReport report_of(const modem_receive_t& packet) {
  ReceptionReport report;
  report.arrival = SimTime::from_utime(packet.arrival_utime);
  report.rate = packet.rate_number;
  report.num_frames = packet.num_frames;
  report.num_bad = packet.num_frames - std::popcount(static_cast<std::uint64_t>(packet.frames_good));
  report.mode = report.num_bad > 0 ? ReceptionReport::Mode::kBadCrc : ReceptionReport::Mode::kGood;
  report.level_db = packet.received_level_db;
  report.noise_db = packet.noise_level_db;
  report.snr_db = packet.snr_db;
  report.sinr_db = packet.sinr_db;
  report.snr_out_db = packet.snr_out_db;
  report.doppler_factor = packet.strongest_path_doppler_factor;
  return report;
}

ReceptionReport report_of(const packet_outcome_t& loss, SimTime arrival) {
  const bool broke_off = loss.outcome == packet_outcome_t::HALF_DUPLEX ||
                         loss.outcome == packet_outcome_t::RECEIVER_GONE ||
                         loss.outcome == packet_outcome_t::ASLEEP;
  ReceptionReport report;
  report.mode = broke_off ? ReceptionReport::Mode::kTimeOut : ReceptionReport::Mode::kBadCrc;
  report.arrival = arrival;
  report.rate = loss.rate_number;
  report.num_frames = report.num_bad = loss.num_frames;
  report.level_db = loss.received_level_db;
  report.noise_db = loss.noise_level_db;
  report.snr_db = loss.snr_db;
  report.sinr_db = loss.sinr_db;
  // Eb/N0 = SINR B / R, with bandwidth B and bit rate R.
  const MicromodemRate& rate = micromodem_rate(std::clamp(loss.rate_number, 0, kMicromodemRates - 1));
  report.snr_out_db = loss.sinr_db + db_of(rate.bandwidth_hz / rate.bit_rate_bps);
  report.doppler_factor = loss.strongest_path_doppler_factor;
  return report;
}

std::string cacst(const ReporterState& modem, const ReceptionReport& r) {
  const double sinr = ratio_of(r.sinr_db);
  // Peak of the matched filter: 32767 * 10^((level - 180 dB) / 20), at least 1 and at most 32767.
  const long peak =
      std::clamp(std::lround(kFullScale * elementary::exp10((r.level_db - kFullScale_db) / 20)), 1L, 32767L);
  const std::string arrival =
      modem.version != kOldVersion
          ? std::to_string(modem.version) + "," + std::to_string(static_cast<int>(r.mode)) + "," +
                modem.clock.yyyymmdd(r.arrival) + modem.clock.hhmmss(r.arrival, 6)
          : std::to_string(static_cast<int>(r.mode)) + "," + modem.clock.hhmmss(r.arrival, 4);
  const int mode = modem.has_clock_sources ? clock_sources(modem.clock) : clock_mode(modem.clock);
  return fmt::format("CACST,{},{},{},{:.0f},{:.0f},{:.0f},{},0,0,0,0,", arrival, mode, peak,
                     2 * db_of(static_cast<double>(peak)), r.snr_db, r.level_db, modem.gain) +
         fmt::format("{},{},{},{},{},{},{},{:.0f},{:.0f},{:.0f},{:.0f},{:.1f},{:.0f},{:.2f},{:.0f},{},{:.0f}",
                     r.rate, r.source, r.destination, r.psk_error, static_cast<int>(r.type), r.num_frames,
                     r.num_bad, r.snr_db, r.snr_db, r.snr_out_db, r.sinr_db, mse_db(r.sinr_db),
                     255 * sinr / (1 + sinr), kSoundSpeed_mps * (r.doppler_factor - 1), r.noise_db,
                     modem.carrier_hz,
                     micromodem_rate(std::clamp(r.rate, 0, kMicromodemRates - 1)).bandwidth_hz) +
         (modem.version == kNewestVersion ? ",0,-1,-1,00" : "");
}

std::string caxst(const ReporterState& modem, const TransmissionReport& t) {
  const bool is_newest = modem.version == kNewestVersion;
  const std::string version =
      modem.version == kOldVersion ? "" : std::to_string(is_newest ? kNewestTransmission : kVersion) + ",";
  return fmt::format("CAXST,{}{},{},{},{},{},{:.0f},{},{},{},{},{},{},{},{},{}", version,
                     modem.clock.yyyymmdd(t.at), modem.clock.hhmmss(t.at, is_newest ? 6 : 4),
                     clock_mode(modem.clock), static_cast<int>(t.mode), kProbeLength,
                     micromodem_rate(std::clamp(t.rate, 0, kMicromodemRates - 1)).bandwidth_hz,
                     modem.carrier_hz, t.rate, t.source, t.destination, t.wants_ack ? 1 : 0,
                     t.frames_expected, t.frames_sent, static_cast<int>(t.type), t.bytes) +
         (is_newest ? "," + std::to_string(modem.carrier_hz) : "");
}

}  // namespace halocline::modem_gateway
