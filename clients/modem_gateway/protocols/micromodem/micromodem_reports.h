// SPDX-License-Identifier: BSD-3-Clause
// What a Micromodem reports of a reception (CACST) and of a transmission (CAXST), filled from the reception
// itself.
//
//   CACST   mode, time of arrival, clock mode, peak, power, ratio, level, gain, 4 shifts, rate, source,
//           destination, PSK error, packet type, frames, bad frames, SNR RSS, SNR in, SNR out, SNR of
//           symbols, MSE, quality, Doppler, noise, carrier, bandwidth
//   CAXST   date, time, clock mode, transmit mode, probe length, bandwidth, carrier, rate, source,
//           destination, acknowledgement, frames expected, frames sent, packet type, bytes
//
// The second generation sends version 6: the version first, and the time of arrival as yyyymmddhhmmss.ffffff
// in the place of hhmmss.ssss. Firmware from 3 on sends CACST in version 8, with four more fields
// (0,-1,-1,00), and CAXST in version 7, with microseconds and the carrier once more. Numbers that are the
// modem's own:
//   peak     of the matched filter, 32767 at 180 dB re 1 uPa;  power = 20 log10(peak), dB;  ratio = SNR, dB
//   SNR in   of all paths into the receiver, SNR of symbols after its window, SNR out per bit, RSS as in; dB
//   quality  255 SINR / (1 + SINR)
//   Doppler  1500 m/s (f_rx / f_tx - 1)
#pragma once

#include <cstdint>
#include <string>

#include "bus/messages.h"
#include "clients/modem_gateway/protocols/micromodem/modem_clock.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {

// Sizes of the Micromodem's packets by rate.
struct MicromodemRate {
  int max_frames;
  int frame_bytes;
  double bit_rate_bps;
  double bandwidth_hz;  // 4 kHz of FSK, 5 kHz of PSK
};
inline constexpr int kMicromodemRates = 7;
// `rate`: 0 to 6.
const MicromodemRate& micromodem_rate(int rate);

enum class MicromodemPacket { kUnknown = -1, kFsk = 1, kFskMini = 2, kPsk = 3, kPskMini = 4, kFlexible = 5 };

struct ReceptionReport {
  enum class Mode { kGood = 0, kBadCrc = 1, kTimeOut = 2 };
  Mode mode = Mode::kGood;
  SimTime arrival;
  int rate = 0;
  std::int32_t source = 0, destination = 0;  // addresses
  int psk_error = 0;                         // 0 none, 3 CRC of a frame, 5 time-out of the equaliser
  MicromodemPacket type = MicromodemPacket::kUnknown;
  int num_frames = 0, num_bad = 0;
  double level_db = 0, noise_db = 0, snr_db = 0, sinr_db = 0, snr_out_db = 0;
  double doppler_factor = 1;
};
// All but addresses and kind, which the door knows.
ReceptionReport report_of(const modem_receive_t& packet);
// `arrival`: by the vehicle's clock.
ReceptionReport report_of(const packet_outcome_t& loss, SimTime arrival);

struct TransmissionReport {
  enum class Mode { kGood = 0, kInhibited = 3, kDataTimeOut = 4 };
  Mode mode = Mode::kGood;
  SimTime at;
  int rate = 0;
  std::int32_t source = 0, destination = 0;
  bool wants_ack = false;
  int frames_expected = 0, frames_sent = 0;
  MicromodemPacket type = MicromodemPacket::kUnknown;
  int bytes = 0;
};

// Of the modem that reports.
inline constexpr int kOldVersion = 0, kVersion = 6, kNewestVersion = 8;
struct ReporterState {
  const ModemClock& clock;
  int version = kVersion;         // of CACST
  bool has_clock_sources = true;  // in its clock mode, firmware from 2.0.26038 on
  int gain = 0;                   // of the receiver, its setting AGN
  int carrier_hz = 0;
  int level = 0;  // of the transmitter, its setting pwramp.txlevel
};
// Bodies of sentences, without $ and checksum.
std::string cacst(const ReporterState& modem, const ReceptionReport& report);
std::string caxst(const ReporterState& modem, const TransmissionReport& report);

}  // namespace halocline::modem_gateway
