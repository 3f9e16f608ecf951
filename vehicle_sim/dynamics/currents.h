// SPDX-License-Identifier: BSD-3-Clause
// The water's own motion: currents as a sum of parts, and the orbital motion of waves on top.
//
// Parts, all in the world frame (NED) over ground:
// - uniform: steady, the same everywhere;
// - by depth: a table of horizontal velocities, linear between its depths, constant beyond;
// - tide: amplitude cos(2 pi t / period + phase) toward an azimuth (one constituent, rectilinear);
// - random: a Gauss-Markov process in north and in east (core/gauss_markov.h), the same everywhere; its value
//   at an instant depends on neither the step nor the order of evaluation;
// - a field of place, depth and time (ocean/ocean_field.h), the same for every vehicle simulator that reads
//   its file.
// What acts on a vehicle within a step: the velocity where it is at the start of the step, changed evenly by
// the acceleration. Uniform, tide and random carry a neutrally buoyant vehicle along exactly: the path is
// that in still water plus the integral of the velocity. The parts by depth and by place act as relative
// velocity at CO, a field also by the acceleration of the water there, so that it carries what starts with it
// round its eddies; neglected are the shear over the hull (it would turn a pitched hull), and the change of
// the added mass's momentum on the way through the shear (rate of place times the gradient, below 0.01 m/s^2
// in the sea). Source: Fossen 2021, section 10.3, for irrotational currents and first-order Gauss-Markov
// processes.
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
  double amplitude_mps = 0;    // 0 or above; 0: none
  double period_s = 44714.16;  // M2, the principal lunar tide; above 0
  double phase_rad = 0;        // at time 0; 0: full speed toward `toward_rad`
  double toward_rad = 0;       // clockwise from north
};

struct RandomCurrent {
  double deviation_mps = 0;  // of north and of east each; 0: none
  double time_s = 600;       // correlation time, 0.1 to 1e6
};

struct CurrentSettings {
  Vec3 uniform_ned_mps = Vec3::Zero();
  std::vector<DepthCurrent> by_depth;  // depths rising; empty: none
  TidalCurrent tide;
  RandomCurrent random;

  void archive(Archive& a) { a(uniform_ned_mps, by_depth, tide, random); }
};

class OceanCurrent {
 public:
  // Throws InvalidArgument where a setting lies outside of its range. `seed`: of the random part.
  OceanCurrent(const CurrentSettings& settings, std::uint64_t seed);

  // What is the same everywhere, at `now`; the acceleration is that which leads to its value a step later.
  WaterMotion everywhere(SimTime now, SimDuration step);
  // What depends on depth alone; `depth_m` below the surface, of any sign.
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

// At a place (north, east, depth below the surface, m); the acceleration is that of the water which is there.
WaterMotion motion_of(const ocean::OceanField& field, const Vec3& place, SimTime now, SimDuration step);

}  // namespace halocline::vehicle_sim
