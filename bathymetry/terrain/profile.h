// SPDX-License-Identifier: BSD-3-Clause
// Bottom along a straight line of the plane: sampled at equal distances, or exactly, cell by cell.
//
// Equidistant samples cost 15 ns each and miss what lies between them, such as a ridge narrower than the
// step. The exact profile has a point wherever the line crosses a cell edge, where the surface has its kinks,
// and at every extremum (summit or trough) inside a cell, where the surface is a parabola. So its shallowest
// point is the shallowest of the line. Between two points depth is monotonic and a parabola.
#pragma once

#include <cstddef>
#include <vector>

#include "bathymetry/terrain/terrain.h"

namespace halocline::bathymetry {

// A point of the plane, local NED.
struct PlanePoint {
  double x_m = 0, y_m = 0;
};

struct ProfilePoint {
  double distance_m = 0;  // along the line from its first point
  double z_m = kUnknown;  // z of the bottom; NaN unless ok
  DepthStatus status = DepthStatus::kOutside;
};

// Returns `count` samples (2 or more) from `from` to `to`, both included; sample k lies at the distance k
// length / (count - 1). A line of length 0 repeats its point. Ends that are not finite: every sample is
// bad_input.
std::vector<ProfilePoint> uniform_profile(const Terrain& terrain, PlanePoint from, PlanePoint to,
                                          std::size_t count);

// Returns a point for every crossing and extremum, in the order of the line, from its first point to its
// last. A stretch outside or without data begins and ends with a point of that status (at the distance of the
// neighbouring ok point). Ends that are not finite: one point, bad_input. Length 0: one point.
std::vector<ProfilePoint> exact_profile(const Terrain& terrain, PlanePoint from, PlanePoint to);

}  // namespace halocline::bathymetry
