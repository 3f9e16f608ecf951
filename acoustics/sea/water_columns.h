// SPDX-License-Identifier: BSD-3-Clause
// Sound speeds of several columns of water at common depths: where to have knots, so that all are linear
// between them.
//
// One column is a profile's own table of knots (acoustics/sea/ray_water.h); several are those of a section.
// Free functions on values: calls may overlap between threads.
#pragma once

#include <functional>
#include <vector>

namespace halocline::acoustics {

struct WaterColumns {
  std::vector<double> depths_m;                 // rising
  std::vector<std::vector<double>> speeds_mps;  // of each column, at each depth
};

// The speed of a column at a depth.
using ColumnSpeed = std::function<double(std::size_t column, double depth_m)>;

// At the depths given, rising from 0, and at others between them, by halving, where the straight line would
// be further than the tolerance from one of the columns, or the layer taller than 250 m; none thinner than 1
// m.
WaterColumns sampled(const std::vector<double>& depths_m, std::size_t columns, const ColumnSpeed& speed,
                     double tolerance_mps);
// The fewest of the depths, first and last among them, between which all columns stay within the tolerance.
WaterColumns thinned(const WaterColumns& columns, double tolerance_mps);

}  // namespace halocline::acoustics
