// SPDX-License-Identifier: BSD-3-Clause
// Reader of the [terrain] section of a scenario into a TerrainRecipe.
#pragma once

#include "bathymetry/rasters/terrain_recipe.h"
#include "bus/config/config.h"

namespace halocline::bathymetry {

// Visits [terrain] and its subsections: [terrain.flat], [terrain.slope], [terrain.ridge], [terrain.seamount],
// [terrain.raster], [terrain.relief], [[terrain.nested]]. Angles are in degrees in the file, in radians in
// the recipe.
void visit(bus::ConfigVisitor& v, TerrainRecipe& recipe);

}  // namespace halocline::bathymetry
