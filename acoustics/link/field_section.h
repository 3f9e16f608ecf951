// The water between two places of a sea with a field of temperature and salinity, as rays see it.
//
// Model: the field is linear between its points (ocean/ocean_field.h); sound speed is the environment's formula of it. Columns
// stand at both places and where the line between them crosses rows and columns of the field's grid. Knots are shared by all
// of them: the field's depths and what lies between where the speed bends (acoustics/sea/water_columns.h); layers in which
// its gradient changes along the line are at most 10 m tall. Then the line is halved until the triangles between columns
// (acoustics/sea/ray_section.h) are within the tolerance of the speed in their middle, into strips of 20 m at least. A kink at
// which some column has a minimum of the speed is rounded in each of them as far as rounded_channels() would, by sixteen
// pieces of the parabola, which share knots. Absorption is the environment's formula in each column.
//
// Where all columns are alike within 1e-6 m/s there is no section: the water is that of ray_water() at the first place, and
// rays are those of the layered search to the last bit.
//
// Error of travel time against the field: below tolerance / speed of it, mostly a tenth of that, as errors of both signs
// cancel. Free function on values: calls may overlap between threads.
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

// The places by their north and east, m; ranges are from the first. What lies deeper than `deepest_m`, where no ray goes, is not
// looked at. The tolerance as of ray_water(): 0 is kSpeedTolerance. The environment has a field.
LinkWater water_between(const Environment& environment, const Vec3& from_ned_m, const Vec3& to_ned_m,
                        double deepest_m, double frequency_hz, double tolerance_mps);

}  // namespace halocline::acoustics
