// SPDX-License-Identifier: BSD-3-Clause
// The ground under and ahead of a vehicle, from what its altimeter saw on the way: how low it may go, and
// how to keep a height.
//
// Model: each echo is a point of the ground, z = z_vehicle + a cos(pitch) cos(roll), at a sin(pitch) ahead
// along the way. A straight line through the points of the last kWindowM of way (least squares) gives the
// ground now and `ahead_m` on. To keep a height, the shallower of the two sets the depth, and the line's
// slope the climb. Below the least height the vehicle is pulled up as hard as its gains allow. An echo
// counts for kOldestS; without one the last depth is kept, and where the altimeter reports no
// bottom within its reach a vehicle that is to keep a height goes down.
//
// Tolerance of a height kept: over ground whose slope changes by s over the window plus the way ahead,
// about s times that length; measured in docs/validation.md. Left out: ground that rises more steeply than
// the greatest pitch, walls (the altimeter looks down, there is no sonar forward), the altimeter's beam
// width.
#pragma once

#include <deque>
#include <optional>

#include "clients/autopilot/guidance.h"
#include "core/archive.h"
#include "core/frames.h"

namespace halocline::clients {

// One look of the altimeter, and where the vehicle was.
struct AltimeterLook {
  double time_s = 0;
  Vec3 position_ned_m = Vec3::Zero();
  EulerAngles attitude;
  bool has_echo = false;  // false: no bottom within its reach
  double altitude_m = 0;  // along the vehicle's down axis

  void archive(Archive& a) { a(time_s, position_ned_m, attitude, has_echo, altitude_m); }
};

// The ground as a line along the way.
struct GroundLine {
  double z_ned_m = 0;  // below the vehicle
  double slope = 0;    // z per metre of way, above 0: falls away ahead
  double time_s = 0;   // of the last echo
};

class SeabedAhead {
 public:
  static constexpr double kWindowM = 10, kOldestS = 5;

  void add(const AltimeterLook& look);
  // The ground at the latest look; empty when no echo is younger than kOldestS at `time_s`.
  std::optional<GroundLine> ground(double time_s) const;
  // Whether the latest look, not older than kOldestS, saw no bottom.
  bool sees_no_bottom(double time_s) const;
  void clear() { *this = {}; }
  void archive(Archive& a) { a(points_, last_, way_m_); }

 private:
  struct Point {
    double way_m, z_ned_m, time_s;
  };
  std::deque<Point> points_;
  std::optional<AltimeterLook> last_;
  double way_m_ = 0;
};

// How heights are kept.
struct SeabedRules {
  double min_altitude_m = 3;  // 0 or above
  double ahead_m = 4;         // how far ahead the ground is looked at, 0 or above
};

// The set points with the ground taken into account: height instead of depth where one is set, and the
// minimum height always. `z_ned_m`: of the vehicle.
SetPoints above_ground(const SeabedRules& rules, const SeabedAhead& seabed, double time_s, double z_ned_m,
                       SetPoints points);

}  // namespace halocline::clients
