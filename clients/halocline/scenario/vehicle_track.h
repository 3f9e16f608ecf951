// SPDX-License-Identifier: BSD-3-Clause
// Where a vehicle was at any time of a recorded run, smoothly: between two states by the cubic that has their
// positions and velocities, beyond the first and the last along a straight line.
#pragma once

#include <map>
#include <string>

#include "bathymetry/rasters/terrain_recipe.h"
#include "clients/halocline/analysis/recording.h"
#include "clients/halocline/scenario/composition.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::clients {

// The run of the scenario's vehicles on its terrain until `end`.
Recording record_run(const ScenarioConfig& config, const bathymetry::PreparedTerrain& terrain, SimTime end);

class VehicleTrack {
 public:
  struct Place {
    Vec3 position_ned_m, velocity_ned_mps;
  };
  // Throws InvalidArgument, with the name, where the recording holds no state of it.
  VehicleTrack(const Recording& recording, const std::string& vehicle);

  Place at(SimTime time) const;

 private:
  std::map<SimTime, Place> places_;
};

}  // namespace halocline::clients
