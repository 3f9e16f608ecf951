// SPDX-License-Identifier: BSD-3-Clause
// Tide: height of the sea surface above its mean level, a sum of harmonic constituents.
//
//   h(t) = sum of A_i cos(2 pi t / T_i - phase_i)
//
// t is simulation time. The same height holds everywhere in a scenario, and no current follows from it. The
// z of the surface in the world frame is that of its mean less h.
//
//   const Tide tide{{{.amplitude_m = 1}}};  // M2
//   const double height_m = tide.height_m(10'000);  // 0.1649
#pragma once

#include <vector>

namespace halocline {

inline constexpr double kLunarSemidiurnalS = 44714.16;  // period of the constituent M2, s

struct TideConstituent {
  double amplitude_m = 0;                // 0..20
  double period_s = kLunarSemidiurnalS;  // 600..1e8
  double phase_rad = 0;                  // the height is greatest at t = phase_rad / (2 pi) period_s
  bool operator==(const TideConstituent&) const = default;
};

struct Tide {
  std::vector<TideConstituent> constituents;  // empty: the level does not move

  bool moves() const { return !constituents.empty(); }
  double height_m(double time_s) const;
  double rate_mps(double time_s) const;  // dh/dt
  // Upper bound of |dh/dt| at all times, m/s.
  double max_rate_mps() const;
  bool operator==(const Tide&) const = default;
};

}  // namespace halocline
