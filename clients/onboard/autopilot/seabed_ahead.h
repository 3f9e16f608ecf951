// SPDX-License-Identifier: BSD-3-Clause
// Seabed under and ahead of a vehicle, estimated from its altimeter's echoes: limits the depth and keeps a
// height.
//
// Model: an altitude a, measured at the vehicle's z, is a point of the seabed at
//
//   z_seabed = z + a cos(pitch) cos(roll),  a sin(pitch) cos(roll) ahead along the path
//
// A straight line through the points of the last kWindowM of path (least squares) gives the seabed at the
// vehicle and `ahead_m` further on. To keep a height, the shallower of the two determines the depth, and the
// line's slope the climb. Below the minimum height the vehicle is pulled up as hard as its gains allow. An
// echo is used for kOldestS. Without one the depth is kept, except that a vehicle that is to keep a height
// descends while its altimeter reports no bottom within reach.
//
// Tolerance of the height kept: over a seabed whose slope changes by s within the window and the distance
// ahead, about s times that length; measured in docs/validation.md. Left out: a seabed steeper than the
// maximum pitch, walls (the altimeter looks down, there is no forward-looking sonar), the altimeter's beam
// width.
#pragma once

#include <deque>
#include <optional>

#include "clients/onboard/autopilot/guidance.h"
#include "core/archive.h"
#include "core/frames.h"

namespace halocline::clients {

// One measurement of the altimeter, and the vehicle's position and attitude at it.
struct AltimeterSample {
  double time_s = 0;
  Vec3 position_ned_m = Vec3::Zero();
  EulerAngles attitude;
  bool has_echo = false;  // false: no bottom within reach
  double altitude_m = 0;  // m along the vehicle's down axis

  void archive(Archive& a) { a(time_s, position_ned_m, attitude, has_echo, altitude_m); }
};

// Seabed as a straight line along the vehicle's path.
struct SeabedLine {
  double z_ned_m = 0;  // z of the seabed at the vehicle
  double slope = 0;    // z per metre of path; above 0: the seabed falls away ahead
  double time_s = 0;   // time of the latest echo
};

class SeabedAhead {
 public:
  static constexpr double kWindowM = 10, kOldestS = 5;

  void add(const AltimeterSample& sample);
  // Returns the line at the latest measurement; empty when no echo is younger than kOldestS at `time_s`.
  std::optional<SeabedLine> line(double time_s) const;
  // True when the latest measurement is not older than kOldestS and saw no bottom, and there is no line to go
  // by.
  bool sees_no_bottom(double time_s) const;
  void clear() { *this = {}; }
  void archive(Archive& a) { a(points_, last_, way_m_); }

 private:
  struct Point {
    double way_m, z_ned_m, time_s;
  };
  std::deque<Point> points_;
  std::optional<AltimeterSample> last_;
  double way_m_ = 0;
};

struct SeabedRules {
  double min_altitude_m = 3;  // minimum height, 0 or above
  double ahead_m = 4;         // distance ahead at which the seabed is considered, 0 or above
};

// Returns the set points adapted to the seabed: the depth follows from the height where one is set, and the
// minimum height is always observed. `z_ned_m`: z of the vehicle.
SetPoints above_seabed(const SeabedRules& rules, const SeabedAhead& seabed, double time_s, double z_ned_m,
                       SetPoints points);

}  // namespace halocline::clients
