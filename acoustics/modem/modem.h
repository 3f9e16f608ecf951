// SPDX-License-Identifier: BSD-3-Clause
// An acoustic modem: source level, band, least receivable level, framing of packets, detection and bit
// errors.
//
// The generic profile takes the four parameters of Sehgal, Cernea and Birk 2010: strength (source level),
// cut-off (least receivable level), bandwidth and centre frequency. Those of real modems are data:
// models/modems/*.toml, read by channel_server/modems/modem_config.h.
// A value; nothing here knows a bus or a clock. The transducer's pattern in elevation weighs the paths of
// sound at both ends; noise comes from all around and is weighed by the directivity index alone. Left out:
// patterns in bearing.
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
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::acoustics {

// The largest payload of any packet, bytes.
inline constexpr std::int32_t kMaxPayloadBytes = 32'768;

// How a packet is put together. A frame is sent whole, however few of its bytes are used.
struct FrameLayout {
  std::int32_t header_bits = 0;       // a coded block before the payload that has to be right as well
  std::int32_t tail_bits = 0;         // that end the code, after every coded block; carry nothing
  std::int32_t frame_bytes = 0;       // 0: the payload is sent as it is, in no frames
  std::int32_t max_frames = 0;        // in one packet, at most kMaxFrames; read only with frame_bytes above 0
  std::int32_t mini_packet_bits = 0;  // of a mini-packet, all of it; 0: the modem has none
  std::int32_t application_bits = 0;  // of the header, free for applications (JANUS: 34); 0: none
  bool operator==(const FrameLayout&) const = default;
};

// The defaults are one generic modem of the 25 kHz class with the band of the reference figures.
struct Modem {
  // The waveform family: only modems of one family receive each other. A name (core/names.h).
  std::string family = "generic";
  // Strength: dB re 1 uPa at 1 m over the band, 0..250. Real modems give 160..190 (WHOI Micromodem about
  // 185); the paper's figures use 60..120, which is 120 dB = 8.4 microwatts.
  Decibels source_level{185};
  // Cut-off: the least level that is received, dB re 1 uPa over the band, -200..250. 70 dB is 10 dB above the
  // noise of a still sea in the default band (59.3 dB).
  Decibels min_receivable_level{70};
  double centre_frequency_hz = 25'000;  // 10..1e6
  double bandwidth_hz = 5'000;          // above 0, below twice the centre frequency
  Decibels directivity_index{0};        // gain of reception over noise from all around, dB, 0..40
  double bit_rate_bps = 80;             // of information, above 0, at most 1e7; 80 is the Micromodem's FH-FSK
  // Everything a packet takes besides its coded bits (preamble, header, check), 0..60 s.
  SimDuration packet_overhead;

  // The first part of the overhead, by which the packet is detected, 0..60 s. 0: it is always detected.
  SimDuration preamble;
  std::int32_t preamble_pieces = 1;  // 1..256, matched each, added without phase (preamble_detection.h)
  // An echo this much later than the instant the receiver synchronised to, or less, adds to the signal.
  // 0..10 s; 10 ms is our choice, near a bit of 80 bit/s.
  SimDuration guard_time = SimDuration::from_milliseconds(10);
  // After the guard time the weight of an echo falls from 1 to 0 by a raised cosine over this much, 0..10 s.
  // None: over one more guard time, whatever that is; guard_taper_or_default() gives it.
  std::optional<SimDuration> guard_taper;

  // Frequency-hopped FSK: duration of a chip, 0..10 s, and pairs of tones to hop between, 0..1024; 0 of both:
  // no hopping. The packet's own echo that is later than a chip takes nothing until the pattern returns to
  // its tones, hop_clearing after them (chip..60 s), and 1 / hop_count of its power later.
  SimDuration chip;
  std::int32_t hop_count = 0;
  SimDuration hop_clearing;

  // Greatest |f_rx / f_tx - 1| at which a packet can be received in a sea without fading, 0..1; with fading
  // doppler_correction decides. 0.1 is 150 m/s: of no effect on submarines, because the generic modem stands
  // for no Doppler correction in particular.
  double doppler_tolerance = 0.1;
  // Greatest |f_rx / f_tx - 1| that the receiver corrects, 0..1; what is left of a greater one costs power.
  double doppler_correction = 0.1;
  SimDuration time_quantum;  // resolution of the measured time of arrival, 0..1 s; 0: none
  ErrorModel error_model = ErrorModel::kBfsk;
  FrameLayout layout;
  BeamPattern beam;  // in transmission and reception; source and cut-off level are those of its 0 dB

  SimDuration guard_taper_or_default() const { return guard_taper.value_or(guard_time); }
  Band band() const {
    return {centre_frequency_hz - bandwidth_hz / 2, centre_frequency_hz + bandwidth_hz / 2};
  }
  bool operator==(const Modem&) const = default;
};

// Throws InvalidArgument, naming the field, its value and what is allowed, unless every field is in range.
void validate(const Modem& modem);

// True without hopping, and when there is a chip that ends before the hop pattern returns.
bool hops_well(const Modem& modem);

// The paper's four parameters on top of the other defaults.
Modem generic_modem(Decibels strength, Decibels cut_off, double centre_frequency_hz, double bandwidth_hz);

struct PacketTiming {
  SimDuration duration;           // from the first of the preamble to the last bit
  SimDuration preamble;           // its part in front
  std::int64_t information_bits;  // that all have to be right: header and whole frames, before coding
};

// How a packet of `payload_bytes` occupies the water (packet_format.h has those of other kinds). The payload
// must not exceed max_payload_bytes (InvalidArgument).
PacketTiming packet_timing(const Modem& modem, std::size_t payload_bytes);

// Largest payload of one packet, bytes: its frames, or kMaxPayloadBytes without frames.
std::size_t max_payload_bytes(const Modem& modem);

// The chance that each instant's noise alone looks like a preamble. A band of some kHz is tested some
// thousand times a second: one false alarm in several hours. Our choice; no modem's own number is public.
inline constexpr double kFalseAlarmProbability = 1e-8;

// The probability that a receiver detects the packet; `sinr` is the ratio of its power to that of noise and
// interference over the modem's band (>= 0), during the preamble. 1 without a preamble.
double acquisition_probability(const Modem& modem, PowerRatio sinr);

// Eb/N0 of an information bit, after despreading and decoding: sinr bandwidth / bit rate, noise and
// interference white over the band.
PowerRatio bit_energy(const Modem& modem, PowerRatio sinr);

// Mean square error of the symbols, of power 1, of an equaliser whose output has the ratio `sinr` of signal
// to noise, interference and what is left of echoes: J = 1 / (1 + sinr) for the linear equaliser of least
// mean square error (Proakis, 4th edition, section 10.2.2).
PowerRatio least_mean_square_error(PowerRatio sinr);

// The probability that an information bit is wrong after decoding, 0..0.5, never rising with `sinr` (as
// above, during the bits).
double bit_error_rate(const Modem& modem, PowerRatio sinr);

// True when `receiver` knows the waveform of `sender`. Another family's sound triggers no detector.
bool same_family(const Modem& sender, const Modem& receiver);

// What a receiver's signal lacks because part of the sender's band lies outside of its own: -10 log10 of the
// share that lies within (band_share), dB, 0..300; 300 without any.
Decibels band_loss(const Modem& sender, const Modem& receiver);

}  // namespace halocline::acoustics
