// An acoustic modem as the water sees it: how loud it is, in which band, what it can still hear, how fast it
// talks.
//
// The generic profile takes the four parameters of Sehgal, Cernea and Birk 2010: strength (source level),
// cut-off (least receivable level), bandwidth and centre frequency. A value; nothing here knows a bus or a
// clock. Left out: beam patterns (one directivity index for reception), modulation, error correction.
#pragma once

#include <cstdint>

#include "acoustics/capacity.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::acoustics {

// The defaults are one generic modem of the 25 kHz class with the band of the reference figures.
struct Modem {
  // Strength: dB re 1 uPa at 1 m over the band, 0..250. Real modems give 160..190 (WHOI Micromodem about
  // 185); the paper's figures use 60..120, which is 120 dB = 8.4 microwatts.
  Decibels source_level{185};
  // Cut-off: the least level that is received, dB re 1 uPa over the band, -200..250. 70 dB is 10 dB above the
  // noise of a still sea in the default band (59.3 dB).
  Decibels least_receivable_level{70};
  double centre_frequency_hz = 25'000;  // 10..1e6
  double bandwidth_hz = 5'000;          // above 0, below twice the centre frequency
  Decibels directivity_index{0};        // gain of reception over noise from all around, dB, 0..40
  double bit_rate_bps = 80;             // of the payload, above 0, at most 1e7; 80 is the Micromodem's FH-FSK
  // Everything a packet takes besides its payload bits (preamble, header, check), 0..60 s.
  SimDuration packet_overhead;

  Band band() const {
    return {centre_frequency_hz - bandwidth_hz / 2, centre_frequency_hz + bandwidth_hz / 2};
  }
  bool operator==(const Modem&) const = default;
};

// Throws InvalidArgument, naming the field, its value and what is allowed, unless every field is in range.
void validate(const Modem& modem);

// The paper's four parameters on top of the other defaults.
Modem generic_modem(Decibels strength, Decibels cut_off, double centre_frequency_hz, double bandwidth_hz);

// How long a packet of `payload_bytes` occupies the water.
SimDuration packet_duration(const Modem& modem, std::size_t payload_bytes);

// True when the two bands share frequencies: only then can one modem hear the other.
bool bands_overlap(const Modem& one, const Modem& other);

}  // namespace halocline::acoustics
