// SPDX-License-Identifier: BSD-3-Clause
// Smooth track of a vehicle through a recorded run: cubic Hermite interpolation between two states from their
// positions and velocities, and a straight line before the first and after the last state.
#pragma once

#include <map>
#include <string>

#include "bathymetry/rasters/terrain_recipe.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "runs/analysis/recording.h"
#include "simulation/composition.h"

namespace halocline::clients {

// Runs the scenario's vehicles on its terrain until `end` and returns the recording.
Recording record_run(const ScenarioConfig& config, const bathymetry::PreparedTerrain& terrain, SimTime end);

// Position and velocity of one vehicle as functions of time, NED, m and m/s.
class VehicleTrack {
 public:
  struct Place {
    Vec3 position_ned_m, velocity_ned_mps;
  };
  // Builds the track. Throws InvalidArgument that names the vehicle when the recording holds no state of it.
  VehicleTrack(const Recording& recording, const std::string& vehicle);

  Place at(SimTime time) const;

 private:
  std::map<SimTime, Place> places_;
};

}  // namespace halocline::clients
