// SPDX-License-Identifier: BSD-3-Clause
// Orbital motion of the water under surface waves.
//
// Model: linear (Airy) waves on deep water, long-crested, a sum of components i of amplitude a, frequency
// omega, wave number k and phase phi, with s along the direction of travel and d the depth (Faltinsen 1990,
// Sea Loads on Ships and Offshore Structures, table 2.1):
//
//   k         = omega^2 / g
//   theta     = k s - omega t + phi
//   elevation = a cos(theta)
//   velocity  = a omega exp(-k d) (cos(theta) along, sin(theta) up)
//
// A sea has the JONSWAP spectrum (Hasselmann et al. 1973), which with peakedness 1 is that of Pierson and
// Moskowitz 1964, scaled to its significant height. Its components have equal bandwidths from half to four
// times the peak frequency. Each frequency is drawn within its band and each phase at random, addressed by
// seed and component (core/random.h), so the sea does not repeat. The model holds for a steepness below about
// 0.1 and water deeper than half a wavelength. Left out: directional spreading, drift, breaking, the bottom.
#pragma once

#include <cstdint>
#include <vector>

#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::vehicle_sim {

// Motion of the water at a place and an instant, world NED.
struct WaterMotion {
  Vec3 velocity_mps = Vec3::Zero();
  Vec3 acceleration_mps2 = Vec3::Zero();  // at a fixed place
};

enum class SeaKind { kCalm, kRegular, kPiersonMoskowitz, kJonswap };

struct WaveSettings {
  SeaKind kind = SeaKind::kCalm;
  double height_m = 1;      // crest to trough of a regular wave, significant height of a sea; 0 or above
  double period_s = 8;      // period of a regular wave, peak period of a sea; 1 to 30
  double toward_rad = 0;    // direction of travel, clockwise from north
  double peakedness = 3.3;  // gamma of JONSWAP; 1 to 10
  int components = 30;      // number of components of a sea, 1 to 1000
};

class WaveField {
 public:
  static constexpr double kGravity = 9.81;  // m/s^2

  // Throws InvalidArgument when a setting is out of its range.
  WaveField(const WaveSettings& settings, std::uint64_t seed);

  struct Component {
    double amplitude_m, frequency_radps, wave_number_per_m, phase_rad;
  };

  // Returns the motion at `depth_m` below the still surface; water above it moves as the surface does.
  WaterMotion at(const Vec3& position_ned_m, double depth_m, SimTime now) const;
  // Returns the elevation of the surface over that place; at a depth, the pressure head of the waves there,
  // the sum of a exp(-k d) cos(theta). At the surface its rate of change is the water's upward velocity, and
  // its slope along the direction of travel the acceleration over -g.
  double elevation_m(const Vec3& position_ned_m, double depth_m, SimTime now) const;
  // Upper bound of the elevation's magnitude, m.
  double highest_m() const;
  const std::vector<Component>& components() const { return components_; }
  bool calm() const { return components_.empty(); }

 private:
  std::vector<Component> components_;
  double north_, east_;  // direction of travel
};

}  // namespace halocline::vehicle_sim
