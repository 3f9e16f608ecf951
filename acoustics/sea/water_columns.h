// SPDX-License-Identifier: BSD-3-Clause
// Sound speeds of several columns of water at common depths: choice of the knots between which all columns
// are linear.
//
// One column is the table of knots of a profile (acoustics/sea/ray_water.h); several columns form a section.
// Free functions on values: calls may overlap between threads.
#pragma once

#include <functional>
#include <vector>

namespace halocline::acoustics {

// Speeds of several columns at common depths.
struct WaterColumns {
  std::vector<double> depths_m;                 // ascending
  std::vector<std::vector<double>> speeds_mps;  // [column][depth]
};

// Returns the sound speed of a column at a depth, m/s.
using ColumnSpeed = std::function<double(std::size_t column, double depth_m)>;

// Samples the columns at the given depths, ascending from 0, and by bisection at further depths between them
// where linear interpolation would be off by more than the tolerance in one of the columns, or the layer
// taller than 250 m; no layer is made thinner than 1 m.
WaterColumns sampled(const std::vector<double>& depths_m, std::size_t columns, const ColumnSpeed& speed,
                     double tolerance_mps);
// A minimal subset of the depths, first and last included, between which all columns are within the
// tolerance.
WaterColumns thinned(const WaterColumns& columns, double tolerance_mps);

}  // namespace halocline::acoustics
