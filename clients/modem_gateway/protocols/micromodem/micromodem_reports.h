// SPDX-License-Identifier: BSD-3-Clause
// Reports of a Micromodem on a reception (CACST) and on a transmission (CAXST), filled from the simulated
// packet.
//
//    CACST   mode, time of arrival, clock mode, peak, power, ratio, level, gain, 4 shifts, rate, source,
//            destination, PSK error, packet type, frames, bad frames, SNR RSS, SNR in, SNR out,
//            SNR of symbols, MSE, quality, Doppler, noise, carrier, bandwidth
//    CAXST   date, time, clock mode, transmit mode, probe length, bandwidth, carrier, rate, source,
//            destination, acknowledgement, frames expected, frames sent, packet type, bytes
//
// The second generation sends version 6, with the version first and the time of arrival as
// yyyymmddhhmmss.ffffff instead of hhmmss.ssss. Firmware from version 3 on sends CACST in version 8, with
// four more fields (0,-1,-1,00), and CAXST in version 7, with microseconds and the carrier repeated at the
// end. Quantities on scales of the modem:
//
//    peak             output of the matched filter, 32767 at 180 dB re 1 uPa
//    power            20 log10(peak), dB
//    ratio            SNR, dB
//    SNR in           at the receiver's input, over all paths, dB; SNR RSS is the same
//    SNR of symbols   SINR within the receiver's guard window, dB
//    SNR out          per bit, dB
//    quality          255 SINR / (1 + SINR), SINR as a ratio
//    Doppler          1500 m/s (f_rx / f_tx - 1)
#pragma once

#include <cstdint>
#include <string>

#include "bus/messages/messages.h"
#include "clients/modem_gateway/protocols/micromodem/modem_clock.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {

// Packet sizes of the Micromodem at one rate.
struct MicromodemRate {
  int max_frames;
  int frame_bytes;
  double bit_rate_bps;
  double bandwidth_hz;  // 4 kHz for FSK, 5 kHz for PSK
};
inline constexpr int kMicromodemRates = 7;
// Returns the sizes at `rate`, 0 to 6.
const MicromodemRate& micromodem_rate(int rate);

enum class MicromodemPacket { kUnknown = -1, kFsk = 1, kFskMini = 2, kPsk = 3, kPskMini = 4, kFlexible = 5 };

// Content of CACST. Levels are in dB re 1 uPa over the band, ratios in dB.
struct ReceptionReport {
  enum class Mode { kGood = 0, kBadCrc = 1, kTimeOut = 2 };
  Mode mode = Mode::kGood;
  SimTime arrival;  // time of the vehicle's clock
  int rate = 0;
  std::int32_t source = 0, destination = 0;  // addresses
  int psk_error = 0;                         // 0 none, 3 CRC error of a frame, 5 time-out of the equaliser
  MicromodemPacket type = MicromodemPacket::kUnknown;
  int num_frames = 0, num_bad = 0;
  double level_db = 0, noise_db = 0, snr_db = 0, sinr_db = 0, snr_out_db = 0;
  double doppler_factor = 1;  // f_rx / f_tx
};
// Fills all fields except addresses and packet type, which the caller knows.
ReceptionReport report_of(const modem_receive_t& packet);
// `arrival` is in time of the vehicle's clock.
ReceptionReport report_of(const packet_outcome_t& loss, SimTime arrival);

// Content of CAXST.
struct TransmissionReport {
  enum class Mode { kGood = 0, kInhibited = 3, kDataTimeOut = 4 };
  Mode mode = Mode::kGood;
  SimTime at;  // start by the vehicle's clock
  int rate = 0;
  std::int32_t source = 0, destination = 0;
  bool wants_ack = false;
  int frames_expected = 0, frames_sent = 0;
  MicromodemPacket type = MicromodemPacket::kUnknown;
  int bytes = 0;
};

// Versions of CACST that the modem reports; the first generation has none.
inline constexpr int kOldVersion = 0, kVersion = 6, kNewestVersion = 8;
struct ReporterState {
  const ModemClock& clock;
  int version = kVersion;         // version of CACST
  bool has_clock_sources = true;  // clock mode with sources, firmware from 2.0.26038 on
  int gain = 0;                   // gain of the receiver, setting AGN
  int carrier_hz = 0;
  int level = 0;  // level of the transmitter, setting pwramp.txlevel
};
// Return the bodies of the sentences, without $ and checksum.
std::string cacst(const ReporterState& modem, const ReceptionReport& report);
std::string caxst(const ReporterState& modem, const TransmissionReport& report);

}  // namespace halocline::modem_gateway
