// SPDX-License-Identifier: BSD-3-Clause
// The orbital motion of the water under surface waves.
//
// Model: linear (Airy) waves on deep water, long-crested, a sum of components i of amplitude a, frequency
// omega, wave number k = omega^2 / g, phase phi: elevation a cos(theta), theta = k s - omega t + phi with s
// along the direction of travel; velocity a omega exp(-k d) (cos(theta) along, sin(theta) up) at depth d
// (Faltinsen 1990, Sea Loads on Ships and Offshore Structures, table 2.1). A sea: JONSWAP (Hasselmann et al.
// 1973), with peakedness 1 Pierson and Moskowitz 1964, scaled to its significant height; components of equal
// width of frequency from half to four times the peak, each frequency drawn within its width and each phase
// drawn, addressed by seed and component (core/random.h), so the sea does not repeat. Holds for steepness
// below about 0.1 and water deeper than half a wavelength. Left out: spreading, drift, breaking, the bottom.
#pragma once

#include <cstdint>
#include <vector>

#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::vehicle_sim {

// How the water moves at a place and an instant, world NED.
struct WaterMotion {
  Vec3 velocity_mps = Vec3::Zero();
  Vec3 acceleration_mps2 = Vec3::Zero();  // at a fixed place
};

enum class SeaKind { kCalm, kRegular, kPiersonMoskowitz, kJonswap };

struct WaveSettings {
  SeaKind kind = SeaKind::kCalm;
  double height_m = 1;      // crest to trough of a regular wave, significant height of a sea; 0 or above
  double period_s = 8;      // of a regular wave, of the peak of a sea; 1 to 30
  double toward_rad = 0;    // direction of travel, clockwise from north
  double peakedness = 3.3;  // of JONSWAP, gamma; 1 to 10
  int components = 30;      // of a sea, 1 to 1000
};

class WaveField {
 public:
  static constexpr double kGravity = 9.81;  // m/s^2

  // Throws InvalidArgument where a setting lies outside of its range.
  WaveField(const WaveSettings& settings, std::uint64_t seed);

  struct Component {
    double amplitude_m, frequency_radps, wave_number_per_m, phase_rad;
  };

  // `depth_m` below the still surface; what is above moves as the surface does.
  WaterMotion at(const Vec3& position_ned_m, double depth_m, SimTime now) const;
  // How high the surface stands above the still one over that place; at a depth, the head of water whose
  // pressure the waves add there: sum of a exp(-k d) cos(theta). Its rate is the water's velocity up, its
  // slope the acceleration over -g (both at the surface).
  double elevation_m(const Vec3& position_ned_m, double depth_m, SimTime now) const;
  // No elevation is higher or lower.
  double highest_m() const;
  const std::vector<Component>& components() const { return components_; }
  bool calm() const { return components_.empty(); }

 private:
  std::vector<Component> components_;
  double north_, east_;  // of the direction of travel
};

}  // namespace halocline::vehicle_sim
