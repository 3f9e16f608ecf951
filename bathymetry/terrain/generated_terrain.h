// SPDX-License-Identifier: BSD-3-Clause
// Terrain from a formula (flat, slope, ridge, seamount), for scenarios without a chart and for tests with a
// known answer.
//
// Model. Each shape gives z of the bottom (m, down) at any point of the plane (local NED); make_grid samples
// it at the posts. A Gaussian of height h and scale w at the distance d is
//
//   h exp(-d^2 / (2 w^2))
//
// Its steepest slope is 0.607 h / w, at d = w; it falls to 1 % of h at d = 3.03 w. Relief is added by
// fractal_relief.h.
#pragma once

#include <functional>
#include <variant>

#include "bathymetry/terrain/height_grid.h"

namespace halocline::bathymetry {

struct FlatShape {
  double depth_m = 100;
};

// Plane: depth_m at the origin, deeper by `slope` per metre in the direction `azimuth_rad`; clamped to 12 000
// m below and above the datum.
struct SlopeShape {
  double depth_m = 100;
  double slope = 0.05;     // dz / d(distance); 0.05 is 2.9 degrees
  double azimuth_rad = 0;  // direction of descent, from north towards east
};

// Endless ridge with a Gaussian section over a flat bottom.
struct RidgeShape {
  double depth_m = 200;                 // far from the crest
  double height_m = 150;                // height of the crest above that; negative: a trench
  double half_width_m = 300;            // Gaussian scale; above 0
  double crest_x_m = 0, crest_y_m = 0;  // a point of the crest
  double azimuth_rad = 0;               // along the crest, from north towards east
};

// Round Gaussian seamount over a flat bottom.
struct SeamountShape {
  double depth_m = 2000;
  double height_m = 1700;  // height of the summit above that; negative: a basin
  double radius_m = 2500;  // Gaussian scale; above 0
  double summit_x_m = 0, summit_y_m = 0;
};

using Shape = std::variant<FlatShape, SlopeShape, RidgeShape, SeamountShape>;

// Returns z of the bottom at (x, y), local NED.
double depth_of(const Shape& shape, double x_m, double y_m);

// Samples the shape at every post. Throws InvalidArgument for parameters out of range.
HeightGrid make_grid(const GridGeometry& geometry, const Shape& shape);

// Samples any function z_m(x_m, y_m) of the plane at every post; NaN is no data.
HeightGrid make_grid(const GridGeometry& geometry, const std::function<double(double, double)>& z_m);

}  // namespace halocline::bathymetry
