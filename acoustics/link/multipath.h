// SPDX-License-Identifier: BSD-3-Clause
// Assesses if an echo from the bottom may interfere with the direct path (the query GETML of the 2010 paper).
//
// Model (Sehgal, Cernea and Birk 2010): rays go from the transmitter to the seabed at several points along
// the line to the receiver, and on from there to the receiver. Each path has the loss of a straight link over
// its total length (leg by leg through c(z) and alpha(z)) and that of the beams at both ends. It counts when
// its level exceeds the receiver's cut-off and terrain blocks neither leg. The bottom reflects all energy in
// every direction: an upper bound. Pure geometry: the caller gives the points of the bottom and if terrain
// blocks their legs. Left out: loss and direction at the bounce, surface echoes, more than one bounce (see
// acoustics/rays).
#pragma once

#include <vector>

#include "acoustics/link/link_kernel.h"
#include "core/frames.h"
#include "core/units.h"

namespace halocline::acoustics {

// A point of the seabed, with flags that are true when terrain blocks the line of sight to it.
struct BottomPoint {
  Vec3 position_ned_m;
  bool blocked_from_transmitter = false;
  bool blocked_to_receiver = false;
};

enum class EchoLikelihood { kUnlikely, kLikely };

// A path with one reflection at the bottom.
struct EchoPath {
  double length_m = 0;      // both legs
  double delay_s = 0;       // over both legs through c(z)
  Decibels level;           // at the receiver, dB re 1 uPa
  bool blocked = false;     // terrain blocks either leg
  bool receivable = false;  // not blocked, and the level exceeds the receiver's cut-off
};

// Result for all points of the bottom.
struct EchoAssessment {
  EchoLikelihood likelihood = EchoLikelihood::kUnlikely;
  std::vector<EchoPath> paths;  // in the order of the bottom points
};

// Fractions of the horizontal distance from transmitter to receiver at which the bottom is to be sampled:
// `count` >= 1 midpoints of equal parts.
std::vector<double> bottom_point_fractions(int count);

// The path by one point; positions as in LinkKernel::budget.
EchoPath echo_path(const LinkKernel& model, const Vec3& from_ned_m, const Vec3& to_ned_m,
                   const BottomPoint& point);

// Assesses all paths. Without points an echo is unlikely; a caller that has no terrain reports "unknown"
// itself.
EchoAssessment assess_echoes(const LinkKernel& model, const Vec3& from_ned_m, const Vec3& to_ned_m,
                             const std::vector<BottomPoint>& points);

}  // namespace halocline::acoustics
