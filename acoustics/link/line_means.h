// SPDX-License-Identifier: BSD-3-Clause
// Mean slowness and absorption along the straight line between two places of a sea with a field.
//
// Model: means of 1 / c and of alpha over the line, whose water is that of the field
// (acoustics/sea/environment.h). Between the crossings of the line with rows, columns and levels of the grid
// all quantities are smooth: Gauss-Legendre quadrature with five nodes a piece, relative error below 1e-12.
//
// Free function on values: calls may overlap between threads. Depths outside of the water are clamped to 0
// and 12 000 m.
#pragma once

#include "acoustics/sea/environment.h"
#include "core/frames.h"

namespace halocline::acoustics {

// Means over a line.
struct LineMeans {
  double slowness_s_per_m = 0, absorption_db_per_km = 0;
};

// Means between two places in NED, m, with the absorption at `frequency_hz`. For two equal places, the values
// there. The environment must have a field.
LineMeans means_along(const Environment& environment, const Vec3& from_ned_m, const Vec3& to_ned_m,
                      double frequency_hz);

}  // namespace halocline::acoustics
