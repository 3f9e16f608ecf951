// SPDX-License-Identifier: BSD-3-Clause
// Motion of the water: currents as a sum of components, to which the orbital motion of waves is added.
//
// Components, all in the world frame (NED) over ground:
//
// - uniform: steady, the same everywhere;
// - by depth: a table of horizontal velocities, linear between its depths, constant beyond;
// - tide: amplitude cos(2 pi t / period + phase) toward an azimuth (one constituent, rectilinear);
// - random: a Gauss-Markov process in north and in east (core/gauss_markov.h), the same everywhere; its value
//   at an instant depends neither on the step nor on the order of evaluation;
// - field: a function of position, depth and time (ocean/ocean_field.h), the same for every vehicle simulator
//   that reads its file.
//
// Within a step a vehicle meets the velocity at its position at the start of the step, changing at a constant
// acceleration. The uniform, tidal and random components carry a neutrally buoyant vehicle along exactly: its
// path is that in still water plus the integral of the velocity. The components by depth and by position act
// as relative velocity at CO, and a field also by the water's acceleration there, so that it carries what
// starts with it round its eddies. Neglected are the shear over the hull (it would turn a pitched hull) and
// the change of the added mass's momentum along the path through the shear (rate of change of position times
// the gradient, below 0.01 m/s^2 in the sea). Source: Fossen 2021, section 10.3, for irrotational currents
// and first-order Gauss-Markov processes.
#pragma once

#include <cstdint>
#include <vector>

#include "core/archive.h"
#include "core/frames.h"
#include "core/gauss_markov.h"
#include "core/sim_time.h"
#include "ocean/ocean_field.h"
#include "vehicle_sim/dynamics/waves.h"

namespace halocline::vehicle_sim {

struct DepthCurrent {
  double depth_m = 0;  // below the sea surface
  double north_mps = 0, east_mps = 0;
};

struct TidalCurrent {
  double amplitude_mps = 0;    // 0 or above; 0: no tide
  double period_s = 44714.16;  // period of M2, the principal lunar tide; above 0
  double phase_rad = 0;        // phase at time 0; 0: maximum speed toward `toward_rad`
  double toward_rad = 0;       // clockwise from north
};

struct RandomCurrent {
  double deviation_mps = 0;  // standard deviation of the north and of the east component; 0: none
  double time_s = 600;       // correlation time, 0.1 to 1e6
};

struct CurrentSettings {
  Vec3 uniform_ned_mps = Vec3::Zero();
  std::vector<DepthCurrent> by_depth;  // in ascending order of depth; empty: none
  TidalCurrent tide;
  RandomCurrent random;

  void archive(Archive& a) { a(uniform_ned_mps, by_depth, tide, random); }
};

class OceanCurrent {
 public:
  // Throws InvalidArgument when a setting is out of its range. `seed`: seed of the random component.
  OceanCurrent(const CurrentSettings& settings, std::uint64_t seed);

  // Returns the components that are the same everywhere, at `now`; the acceleration leads to their value a
  // step later.
  WaterMotion everywhere(SimTime now, SimDuration step);
  // Returns the component that depends on depth alone; `depth_m`: below the surface, of either sign.
  Vec3 at_depth(double depth_m) const;

  const CurrentSettings& settings() const { return settings_; }
  bool depends_on_depth() const { return !settings_.by_depth.empty(); }
  bool depends_on_time() const {
    return settings_.tide.amplitude_mps > 0 || settings_.random.deviation_mps > 0;
  }

 private:
  Vec3 changing_part(SimTime now);

  CurrentSettings settings_;
  GaussMarkovProcess north_, east_;
  GaussMarkovProcess::Cursor north_cursor_, east_cursor_;
};

// Returns the motion of the water at `place` (north, east, depth below the surface, m). The acceleration is
// that of the water parcel which is there.
WaterMotion motion_of(const ocean::OceanField& field, const Vec3& place, SimTime now, SimDuration step);

}  // namespace halocline::vehicle_sim
