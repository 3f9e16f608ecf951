// SPDX-License-Identifier: BSD-3-Clause
// An acoustic modem: source level, band, least receivable level, framing of packets, detection and bit
// errors.
//
// The generic profile has the four parameters of Sehgal, Cernea and Birk 2010: strength (source level),
// cut-off (least receivable level), bandwidth and centre frequency. Profiles of real modems are data:
// models/modems/*.toml, read by channel_server/modems/modem_config.h. A Modem is a value without access to a
// bus or a clock. The transducer's pattern over elevation weights the paths at both ends; noise arrives from
// all directions and is reduced by the directivity index alone. Left out: patterns over bearing.
//
//   const Modem modem = generic_modem(Decibels{185}, Decibels{70}, 25'000, 5'000);
//   const SimDuration duration = packet_timing(modem, 16).duration;  // 1.6 s
//   const double bit_errors = bit_error_rate(modem, to_power_ratio(Decibels{-8}));  // SINR over the band
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "acoustics/math/frequency_band.h"
#include "acoustics/modem/beam_pattern.h"
#include "acoustics/modem/error_model.h"
#include "acoustics/modem/receiver_kind.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::acoustics {

// The largest payload of any packet, bytes.
inline constexpr std::int32_t kMaxPayloadBytes = 32'768;
// Bounds of Modem::receiver_loss, dB, and Modem::late_echo_share. A calibration (simulation/calibration) may
// find receivers better than their theory, and late echoes that disturb more than by their power.
inline constexpr double kMinReceiverLossDb = -20, kMaxReceiverLossDb = 40, kMaxLateEchoShare = 8;

// Structure of a packet. A frame is always sent whole, even if few of its bytes are used.
struct FrameLayout {
  std::int32_t header_bits = 0;  // coded block before the payload, which must also be received
  // Bits after every coded block that terminate the code and carry no information.
  std::int32_t tail_bits = 0;
  std::int32_t frame_bytes = 0;       // 0: the payload is sent unframed
  std::int32_t max_frames = 0;        // in one packet, at most kMaxFrames; ignored when frame_bytes is 0
  std::int32_t mini_packet_bits = 0;  // total bits of a mini-packet; 0: not supported
  std::int32_t application_bits = 0;  // header bits free for applications (JANUS: 34); 0: none
  bool operator==(const FrameLayout&) const = default;
};

// Parameters of a modem. The defaults describe a generic modem of the 25 kHz class with the band of the
// reference figures.
struct Modem {
  // Waveform family: only modems of one family receive each other's packets. A name (core/names.h).
  std::string family = "generic";
  // Source level: dB re 1 uPa at 1 m over the band, 0..250. Real modems have 160..190 (WHOI Micromodem about
  // 185); the paper's figures use 60..120, of which 120 dB is 8.4 microwatts.
  Decibels source_level{185};
  // Least level that is received, dB re 1 uPa over the band, -200..250. 70 dB is 10 dB above the noise of a
  // still sea in the default band (59.3 dB).
  Decibels min_receivable_level{70};
  double centre_frequency_hz = 25'000;  // 10..1e6
  double bandwidth_hz = 5'000;          // above 0, below twice the centre frequency
  Decibels directivity_index{0};        // gain of reception over isotropic noise, dB, 0..40
  double bit_rate_bps = 80;  // information bits, above 0, at most 1e7; 80 is the Micromodem's FH-FSK
  // Duration of a packet in addition to its coded bits (preamble, header, check), 0..60 s.
  SimDuration packet_overhead;

  // Duration of the preamble, the first part of the overhead, by which the packet is detected, 0..60 s. 0:
  // the packet is always detected.
  SimDuration preamble;
  std::int32_t preamble_pieces = 1;  // 1..256, each matched, added incoherently (preamble_detection.h)
  // Greatest delay, after the instant of synchronisation, at which an echo still adds to the signal, 0..10 s.
  // 10 ms is our choice, close to a bit of 80 bit/s.
  SimDuration guard_time = SimDuration::from_milliseconds(10);
  // Taper after the guard time over which the weight of an echo decreases from 1 to 0 as a raised cosine,
  // 0..10 s. Unset: as long as the guard time (guard_taper_or_default()).
  std::optional<SimDuration> guard_taper;

  // Frequency-hopped FSK: duration of a chip, 0..10 s, and number of tone pairs to hop between, 0..1024; both
  // 0: no hopping. An echo of the packet itself does not interfere until the pattern may return to its tones,
  // hop_clearing (0..60 s) later: 0 where the next chip may be on the same pair (JANUS). From then on it lies
  // on the same pair 1 time in hop_count (guard_window.h).
  SimDuration chip;
  std::int32_t hop_count = 0;
  SimDuration hop_clearing;

  // Greatest |f_rx / f_tx - 1| at which a packet can be received without fading, 0..1; with fading
  // doppler_correction is used instead. The default of 0.1 is 150 m/s and has no effect on AUVs, because the
  // generic modem represents no particular Doppler correction.
  double doppler_tolerance = 0.1;
  // Greatest |f_rx / f_tx - 1| that the receiver corrects, 0..1; the remainder of a greater one costs power.
  double doppler_correction = 0.1;
  SimDuration time_quantum;  // resolution of the measured time of arrival, 0..1 s; 0: unlimited
  ErrorModel error_model = ErrorModel::kBfsk;
  // The receiver. With n hydrophones, S the signal, N the noise and I the interference,
  //   SINR = n S / (N 10^(receiver_loss / 10) + I).
  ReceiverKind receiver = ReceiverKind::kEqualiser;
  // Loss against the theory of its error model, dB, -20..40, of acquisition and decoding alike.
  Decibels receiver_loss{0};
  std::int32_t receiver_channels = 1;  // hydrophones combined, 1..64
  double late_echo_share = 1;          // kappa: share of a late echo's power that disturbs, 0..8
  double echo_cancelled = 0;           // eta: share that feedback takes away of an echo it can follow, 0..1
  Decibels impulse_loss{0};            // in impulsive noise, on top of receiver_loss, dB, 0..40
  FrameLayout layout;
  BeamPattern beam;  // pattern of both directions; source level and cut-off refer to its 0 dB

  SimDuration guard_taper_or_default() const { return guard_taper.value_or(guard_time); }
  // Guard time and taper in effect, s. A receiver of the strongest path collects what its band cannot part
  // from it, 1 / bandwidth; all others have guard_time and guard_taper_or_default().
  double window_s() const;
  double window_taper_s() const;
  Band band() const {
    return {centre_frequency_hz - bandwidth_hz / 2, centre_frequency_hz + bandwidth_hz / 2};
  }
  bool operator==(const Modem&) const = default;
};

// Throws InvalidArgument, naming the field, its value and what is allowed, unless every field is in range.
void validate(const Modem& modem);

// True without hopping, or when the chip is longer than 0.
bool hops_well(const Modem& modem);

// The generic modem with the given four parameters and the defaults for all others.
Modem generic_modem(Decibels strength, Decibels cut_off, double centre_frequency_hz, double bandwidth_hz);

// Durations and bits of a packet.
struct PacketTiming {
  SimDuration duration;           // from the begin of the preamble to the last bit
  SimDuration preamble;           // first part of the duration
  std::int64_t information_bits;  // bits that all have to be right: header and whole frames, before coding
};

// Timing of a data packet of `payload_bytes` (packet_format.h has that of other kinds). Throws
// InvalidArgument when the payload exceeds max_payload_bytes().
PacketTiming packet_timing(const Modem& modem, std::size_t payload_bytes);

// Largest payload of one packet, bytes: that of its frames, or kMaxPayloadBytes without frames.
std::size_t max_payload_bytes(const Modem& modem);

// Probability that noise alone triggers the detector at one tested instant. A band of some kHz is tested some
// thousand times a second: one false alarm in several hours. Our choice; no manufacturer publishes this
// value.
inline constexpr double kFalseAlarmProbability = 1e-8;

// Probability that a receiver detects the packet; `sinr` >= 0 is the ratio of its power to that of noise and
// interference over the modem's band, during the preamble. 1 without a preamble.
double acquisition_probability(const Modem& modem, PowerRatio sinr);

// Eb/N0 of an information bit, after despreading and decoding: sinr bandwidth / bit rate, for noise and
// interference that are white over the band; of a pulse, sinr bandwidth chip.
PowerRatio bit_energy(const Modem& modem, PowerRatio sinr);

// Mean square error of the symbols, of power 1, after an equaliser whose output has the ratio `sinr` of
// signal to noise, interference and residual echoes: J = 1 / (1 + sinr) for the linear equaliser of least
// mean square error (Proakis, 4th edition, section 10.2.2).
PowerRatio least_mean_square_error(PowerRatio sinr);

// Probability that an information bit is wrong after decoding, 0..0.5; it never increases with `sinr`, the
// ratio over the band during the bits.
double bit_error_rate(const Modem& modem, PowerRatio sinr);

// Factor on the noise by the receiver's loss and its hydrophones: 10^(receiver_loss / 10) /
// receiver_channels.
double noise_factor(const Modem& receiver);
// Gain of reception over one ideal hydrophone, the inverse of noise_factor() in dB.
Decibels receiver_gain(const Modem& receiver);

// True when both modems have one waveform family. Sound of another family triggers no detector.
bool same_family(const Modem& sender, const Modem& receiver);

// Loss of signal because part of the sender's band lies outside of the receiver's: -10 log10 of the share
// that lies within (band_share), dB, 0..300; 300 when the bands do not overlap.
Decibels band_loss(const Modem& sender, const Modem& receiver);

}  // namespace halocline::acoustics
