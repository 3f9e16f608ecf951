// SPDX-License-Identifier: BSD-3-Clause
// Dead reckoning: the path of a vehicle through the water by its own speed and heading.
//
// Model: the velocity through the water changes linearly between two measurements (trapezium rule) and is
// constant after the last one. Its horizontal part is
//
//   v = speed cos(pitch) (cos(heading), sin(heading))
//
// The vehicle is taken to move where it points, so sideslip and angle of attack cause errors (the REMUS of
// the vehicle simulator ends a sharp turn of 110 degrees 2.7 m beside the position computed here). Currents
// are not included; the caller adds them.
//
// The sum of the magnitudes of all turns is kept as well, for a model of the errors that grow in turns.
//
// Measurements must come in order of time; one that is not later than the last is ignored. The history goes
// back kRemembered.
#pragma once

#include <deque>
#include <utility>

#include <Eigen/Core>

#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::clients {

using Vec2 = Eigen::Vector2d;  // north, east

// Measurements of a vehicle's own motion.
struct OwnMotion {
  SimTime at;
  double water_speed_mps = 0;  // forward speed through the water
  double heading_rad = 0;      // clockwise from north
  double pitch_rad = 0;        // positive nose up
  double depth_m = 0;          // below the sea surface
};

class DeadReckoning {
 public:
  static constexpr SimDuration kRemembered = SimDuration::from_milliseconds(120'000);

  void take(const OwnMotion& motion);
  bool empty() const { return points_.empty(); }
  SimTime last() const { return points_.back().at; }  // not to be called when empty
  // True when `at` lies within the history or after it.
  bool covers(SimTime at) const { return !empty() && at >= points_.front().at; }

  // Returns the displacement through the water since the first measurement, m; requires covers(at).
  Vec2 gone_ne_m(SimTime at) const;
  double depth_m(SimTime at) const;
  // Sum of the magnitudes of all turns since the first measurement, rad; never decreases.
  double turned_rad(SimTime at) const;

  void archive(Archive& a) { a(points_); }

 private:
  struct Point {
    SimTime at;
    Vec2 gone_ne_m, velocity_ne_mps;
    double depth_m;
    double heading_rad;
    double turned_rad;

    void archive(Archive& a) { a(at, gone_ne_m, velocity_ne_mps, depth_m, heading_rad, turned_rad); }
  };
  // Returns the index of the point before `at`, and the fraction of the interval to the next point at which
  // `at` lies, 0 to 1; 0 after the last point.
  std::pair<std::size_t, double> place_of(SimTime at) const;

  std::deque<Point> points_;
};

}  // namespace halocline::clients
