// SPDX-License-Identifier: BSD-3-Clause
// Seabed of a bathymetry::Terrain.
#pragma once

#include <memory>
#include <optional>

#include "bathymetry/terrain/terrain.h"
#include "vehicle_sim/world/seabed.h"

namespace halocline::vehicle_sim {

// There is no seabed beyond the terrain and where it has no data.
class TerrainSeabed : public Seabed {
 public:
  explicit TerrainSeabed(std::shared_ptr<const bathymetry::Terrain> terrain);

  std::optional<SeabedPlane> plane_at(double north_m, double east_m) const override;

 private:
  std::shared_ptr<const bathymetry::Terrain> terrain_;
};

}  // namespace halocline::vehicle_sim
