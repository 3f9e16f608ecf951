// SPDX-License-Identifier: BSD-3-Clause
// Whether an echo from the bottom may interfere with the direct path (the paper's query GETML).
//
// Model: Sehgal, Cernea and Birk 2010: rays go from the transmitter to the seabed at several points along the
// line to the receiver, and on from there to the receiver. Each whole path loses by the law of the straight
// link over its total length (leg by leg through c(z) and alpha(z)) and by the beams at both ends; it counts
// when its level exceeds the receiver's cut-off and terrain blocks neither leg. The bottom reflects all of
// the energy, in every direction: an upper bound. Pure geometry: the caller gives the points of the bottom
// and whether terrain blocks their legs. Left out: loss and direction at the bounce, surface echoes, more
// than one bounce (the ray model's business).
#pragma once

#include <vector>

#include "acoustics/link/link_kernel.h"
#include "core/frames.h"
#include "core/units.h"

namespace halocline::acoustics {

// A point of the seabed and whether terrain stands in the way to it.
struct BottomPoint {
  Vec3 position_ned_m;
  bool blocked_from_transmitter = false;
  bool blocked_to_receiver = false;
};

enum class EchoLikelihood { kUnlikely, kLikely };

// One path by the bottom.
struct EchoPath {
  double length_m = 0;      // both legs
  double delay_s = 0;       // both legs through c(z)
  Decibels level;           // at the receiver, dB re 1 uPa
  bool blocked = false;     // by terrain, on either leg
  bool receivable = false;  // not blocked, and the level exceeds the receiver's cut-off
};

struct EchoAssessment {
  EchoLikelihood likelihood = EchoLikelihood::kUnlikely;
  std::vector<EchoPath> paths;  // as the bottom points were given
};

// Fractions of the horizontal distance from transmitter to receiver at which the bottom is to be sampled:
// `count` >= 1 points in the middles of equal parts.
std::vector<double> bottom_point_fractions(int count);

// One path; positions as in LinkKernel::budget.
EchoPath echo_path(const LinkKernel& model, const Vec3& from_ned_m, const Vec3& to_ned_m,
                   const BottomPoint& point);

// All paths. Without points an echo is unlikely; a caller that could not reach the terrain reports "unknown"
// itself.
EchoAssessment assess_echoes(const LinkKernel& model, const Vec3& from_ned_m, const Vec3& to_ned_m,
                             const std::vector<BottomPoint>& points);

}  // namespace halocline::acoustics
