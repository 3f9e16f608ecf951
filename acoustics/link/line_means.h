// SPDX-License-Identifier: BSD-3-Clause
// Mean slowness and absorption along the straight line between two places of a sea with a field.
//
// Model: integrals of ds / c and of alpha ds over the line, whose water is the field's
// (acoustics/sea/environment.h). Between where the line crosses rows, columns and levels of the grid all is
// smooth: Gauss-Legendre with five nodes a piece, relative error below 1e-12.
//
// Free function on values: calls may overlap between threads. Depths beyond the water are held at its surface
// and 12 000 m.
#pragma once

#include "acoustics/sea/environment.h"
#include "core/frames.h"

namespace halocline::acoustics {

struct LineMeans {
  double slowness_s_per_m = 0, absorption_db_per_km = 0;
};

// NED, m; the absorption at `frequency_hz`. Of ends at one place, the water there. The environment has a
// field.
LineMeans means_along(const Environment& environment, const Vec3& from_ned_m, const Vec3& to_ned_m,
                      double frequency_hz);

}  // namespace halocline::acoustics
