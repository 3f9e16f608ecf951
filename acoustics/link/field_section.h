// SPDX-License-Identifier: BSD-3-Clause
// The water along the line between two places of a sea with a field of temperature and salinity, in the form
// that ray tracing needs.
//
// Model: an ocean model gives the sea at grid points; for rays it is interpolated smoothly. Temperature and
// salinity follow cubics along the field's rows and columns (OceanField::smooth_column_at). Sound speed is
// computed from them by the environment's formula at the field's levels, and is bicubic between
// (acoustics/sea/ray_section.h). There is a column at both places, at each crossing of the line with rows and
// columns of the field's grid, and at three places between two of those; columns are at least 20 m apart.
// Below the first level that no ray reaches, the distance of the knots doubles from one to the next.
// Absorption is computed by the environment's formula in each column, with temperature and salinity linear
// between levels.
//
// If all columns are equal within 1e-6 m/s there is no section: the water is that of ray_water() at the first
// place, and rays are those of the layered search to the last bit.
//
// Error relative to a smooth sea: third order in the grid's spacing for travel times, second order for the
// ray tubes. Relative to a field that is linear between its points, as the rest of the simulator takes it,
// the error of sound speed is c_zz dz^2 / 8. Free function on values: calls may overlap between threads.
#pragma once

#include <memory>

#include "acoustics/sea/environment.h"
#include "acoustics/sea/ray_section.h"
#include "acoustics/sea/ray_water.h"
#include "core/frames.h"

namespace halocline::acoustics {

// The water of a link: a profile, and a section where the water varies along the link.
struct LinkWater {
  RayWater water;                             // profile at the first place
  std::shared_ptr<const RaySection> section;  // null when the water is the same all along the line
};

// The water between two places. Only north and east of the places are used, m; ranges count from the first.
// `deepest_m` is the greatest depth that rays reach; the water below it is not sampled in detail.
// `tolerance_mps` is passed to ray_water() when there is no section. The environment must have a field.
LinkWater water_between(const Environment& environment, const Vec3& from_ned_m, const Vec3& to_ned_m,
                        double deepest_m, double frequency_hz, double tolerance_mps);

}  // namespace halocline::acoustics
