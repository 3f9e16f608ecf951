// SPDX-License-Identifier: BSD-3-Clause
// Spreads of what a scenario does not know of its sea: [uncertainty], from which members of ensembles are
// drawn (ensemble/sea_member.h), and which `halocline calibrate` narrows.
//
// Every spread is one standard deviation of a normal distribution; 0 leaves its quantity as the scenario
// states it. The defaults are choices: noise of a place scatters by 5 to 10 dB about published curves, and
// above 40 kHz nothing of the table of places was measured.
#pragma once

#include <optional>

#include "bus/config/config.h"

namespace halocline::clients {

struct Uncertainty {
  // Level of the ambient noise, dB. Not set: kNoiseDb, or kHighNoiseDb for modems centred above kHighHz.
  std::optional<double> noise_db = {};
  double receiver_db = 2;     // noise by which receivers do worse or better than their profiles, dB
  double bottom_octaves = 1;  // factor of the bottom's roughness and slope, as a power of 2
  double wind_share = 0.2;    // of the wind
  double sediment_rows = 1;   // rows of the table of sediments, towards rock or clay
  double profile_mps = 0.3;   // amplitudes of both modes of the sound-speed profile, m/s
  // Correlation of the noise and the logarithm of the bottom's factor, -1 to 1: a calibration may know their
  // common effect better than each.
  double noise_bottom_correlation = 0;

  static constexpr double kNoiseDb = 5, kHighNoiseDb = 10, kHighHz = 40'000;
  // Returns the spread of the noise for a modem with this centre frequency, dB.
  double noise_db_at(double frequency_hz) const {
    return noise_db.value_or(frequency_hz > kHighHz ? kHighNoiseDb : kNoiseDb);
  }
};

void visit(bus::ConfigVisitor& v, Uncertainty& uncertainty);

}  // namespace halocline::clients
