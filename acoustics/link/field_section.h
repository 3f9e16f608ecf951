// SPDX-License-Identifier: BSD-3-Clause
// The water between two places of a sea with a field of temperature and salinity, as rays see it.
//
// Model: an ocean model states a smooth sea at points. Between them rays see it smooth: temperature and
// salinity by cubics along the field's rows and columns (OceanField::smooth_column_at), sound speed by the
// environment's formula of them at the field's levels, and bicubic between (acoustics/sea/ray_section.h).
// Columns stand at both places, where the line between them crosses rows and columns of the field's grid, and
// at three places between two of those; no nearer than 20 m. Below the first level that no ray reaches knots
// lie each twice as far apart as the last. Absorption is the environment's formula in each column,
// temperature and salinity there linear between levels.
//
// Where all columns are alike within 1e-6 m/s there is no section: the water is that of ray_water() at the
// first place, and rays are those of the layered search to the last bit.
//
// Error against a smooth sea: of third order in the grid's spacing for travel times and of second for the
// tubes. Against a field taken as linear between its points, as the rest of the simulator takes it: c_zz dz^2
// / 8 of the speed. Free function on values: calls may overlap between threads.
#pragma once

#include <memory>

#include "acoustics/sea/environment.h"
#include "acoustics/sea/ray_section.h"
#include "acoustics/sea/ray_water.h"
#include "core/frames.h"

namespace halocline::acoustics {

struct LinkWater {
  RayWater water;                             // at the first place
  std::shared_ptr<const RaySection> section;  // null: the same all along the line
};

// The places by their north and east, m; ranges are from the first. What lies deeper than `deepest_m`, where
// no ray goes, is not looked at. The tolerance is that of ray_water(), where there is no section. The
// environment has a field.
LinkWater water_between(const Environment& environment, const Vec3& from_ned_m, const Vec3& to_ned_m,
                        double deepest_m, double frequency_hz, double tolerance_mps);

}  // namespace halocline::acoustics
