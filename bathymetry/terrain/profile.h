// SPDX-License-Identifier: BSD-3-Clause
// The bottom along a straight line of the plane: sampled evenly, or exactly, cell by cell.
//
// Model: evenly spaced samples cost 15 ns each and miss what lies between them (a ridge narrower than the
// step). The exact profile has a point wherever the line crosses a cell edge, where the surface has its
// kinks, and one wherever it turns (a summit or a trough) inside a cell, where it is a parabola. So its
// shallowest point is the shallowest of the line, and between two points depth is monotone, within a parabola
// of the straight line.
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
  double z_m = kUnknown;  // of the bottom; NaN unless ok
  DepthStatus status = DepthStatus::kOutside;
};

// `count` (from 2) samples from `from` to `to`, both included; sample k lies at distance k length / (count -
// 1). A line of length 0 repeats its point. Not finite: every sample is bad_input.
std::vector<ProfilePoint> uniform_profile(const Terrain& terrain, PlanePoint from, PlanePoint to,
                                          std::size_t count);

// Every crossing and every turn, in the order of the line, from its first point to its last. A stretch that
// is outside or without data begins and ends with a point of that status (at the distance of the neighbouring
// ok point). Not finite: one point, bad_input. Length 0: one point.
std::vector<ProfilePoint> exact_profile(const Terrain& terrain, PlanePoint from, PlanePoint to);

}  // namespace halocline::bathymetry
