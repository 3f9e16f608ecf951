// SPDX-License-Identifier: BSD-3-Clause
// Where a vehicle has gone through the water, by its own speed and heading.
//
// Model: between two measurements the velocity through the water changes evenly (trapezium rule); after the
// last one it stays. Horizontal velocity = speed * cos(pitch), along the heading: the vehicle goes where it
// points, so a drift to the side or an angle of attack is an error (the REMUS of the vehicle simulator ends a
// sharp turn of 110 degrees 2.7 m beside where this puts it). Current is
// the business of whoever uses this.
//
// The sum of all turns, left and right alike, is counted beside it, for whoever reckons with drift in turns.
//
// Times rise; a measurement of the same instant or an earlier one is left out. Kept for kRemembered.
#pragma once

#include <deque>
#include <utility>

#include <Eigen/Core>

#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::clients {

using Vec2 = Eigen::Vector2d;  // north, east

// What a vehicle measures of itself.
struct OwnMotion {
  SimTime at;
  double water_speed_mps = 0;  // forward, through the water
  double heading_rad = 0;      // clockwise from north
  double pitch_rad = 0;        // positive nose up
  double depth_m = 0;          // below the sea surface
};

class DeadReckoning {
 public:
  static constexpr SimDuration kRemembered = SimDuration::from_milliseconds(120'000);

  void take(const OwnMotion& motion);
  bool empty() const { return points_.empty(); }
  SimTime last() const { return points_.back().at; }  // not when empty
  // Whether `at` lies within the history: not dropped yet, not before the first measurement.
  bool covers(SimTime at) const { return !empty() && at >= points_.front().at; }

  // Gone through the water since the first measurement, m; for an instant that it covers.
  Vec2 gone_ne_m(SimTime at) const;
  double depth_m(SimTime at) const;
  // The sum of the turns since the first measurement, rad; rises.
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
  // The point before `at` and how far `at` lies on the way to the next: 0..1; 0 after the last.
  std::pair<std::size_t, double> place_of(SimTime at) const;

  std::deque<Point> points_;
};

}  // namespace halocline::clients
