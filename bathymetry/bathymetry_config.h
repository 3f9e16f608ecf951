// SPDX-License-Identifier: BSD-3-Clause
// The [terrain] section of a scenario: how its keys fill a TerrainRecipe.
#pragma once

#include "bathymetry/rasters/terrain_recipe.h"
#include "bus/config/config.h"

namespace halocline::bathymetry {

// Visits [terrain] and what lies in it: [terrain.flat], [terrain.slope], [terrain.ridge], [terrain.seamount],
// [terrain.raster], [terrain.relief], [[terrain.nested]]. Angles are degrees in the file, radians in the
// recipe.
void visit(bus::ConfigVisitor& v, TerrainRecipe& recipe);

}  // namespace halocline::bathymetry
