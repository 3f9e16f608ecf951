// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/world/terrain_seabed.h"

#include <utility>

#include "core/check.h"

namespace halocline::vehicle_sim {

TerrainSeabed::TerrainSeabed(std::shared_ptr<const bathymetry::Terrain> terrain)
    : terrain_(std::move(terrain)) {
  require(terrain_ != nullptr, "a seabed needs a terrain");
}

std::optional<SeabedPlane> TerrainSeabed::plane_at(double north_m, double east_m) const {
  const bathymetry::DepthSample sample = terrain_->depth_at(north_m, east_m);
  if (sample.status != bathymetry::DepthStatus::kOk) return {};
  return SeabedPlane{sample.z_m, sample.normal_ned()};
}

}  // namespace halocline::vehicle_sim
