// SPDX-License-Identifier: BSD-3-Clause
// Position by the vehicle's own sensors: dead reckoning between fixes.
//
// Model: position moves by the velocity over ground where a Doppler log measures it, else by the speed
// through the water along the hull's axis (heading, pitch), as if the water stood still; velocity changes
// evenly between samples (trapezium). z is the measured depth. Uncertainty: a standard deviation of each
// horizontal axis that grows with time, by `log_drift_mps` while the speed is that through the water (the
// current that is not known) and by `ground_drift` times the way while it is that over ground (the Doppler
// log's scale and the compass): both are lasting errors, so deviations add up, not variances. While the gyro
// carries the heading on without a compass (attitude_keeper.h) it grows by that heading's deviation times the
// way as well, by the way at most. A fix moves the position by P / (P + R) of the difference (Kalman's gain
// with one variance for both axes) and leaves 1 / (1/P + 1/R). So in a current c the error grows as c t, and
// a good fix takes it away. A fix of up to kMemory s ago is compared with the place reckoned then. Left out:
// the current is not estimated, nor the compass's error; sideslip without a Doppler log.
#pragma once

#include <deque>
#include <optional>

#include "core/archive.h"
#include "core/frames.h"

namespace halocline::clients {

struct NavigatorRules {
  double log_drift_mps = 0.1;    // metres a second through unknown currents, 0 or above
  double ground_drift = 0.01;    // metres a metre of way over ground, 0 or above
  double start_deviation_m = 1;  // of the place it is put into the water, 0 or above
  // Of a gyro that carries the heading on without a compass, at most; 0 or above: 36 degrees an hour
  double gyro_bias_radps = 1.7453292519943296e-4;
};

// The sensor readings of an instant.
struct NavigationSample {
  double time_s = 0;
  EulerAngles attitude;
  double depth_m = 0;                              // becomes z
  double water_speed_mps = 0;                      // forward through the water
  std::optional<Vec3> ground_velocity_body_mps{};  // of a Doppler log
  double heading_deviation_rad = 0;                // without a compass, see attitude_keeper.h

  void archive(Archive& a) {
    a(time_s, attitude, depth_m, water_speed_mps, ground_velocity_body_mps, heading_deviation_rad);
  }
};

class Navigator {
 public:
  // `start_ned_m`: where the vehicle is put into the water.
  Navigator(const Vec3& start_ned_m, NavigatorRules rules);

  // Samples come in order of time; one that is not later than the last is ignored.
  void add(const NavigationSample& sample);
  // A position measured at the latest sample, or at `time_s`; `deviation_m` of each axis, above 0. One from
  // before the history is ignored.
  void fix(double north_m, double east_m, double deviation_m);
  void fix(double north_m, double east_m, double deviation_m, double time_s);

  // The position of another estimator that uses all data of this one and more: replaces this one's.
  void replace(double north_m, double east_m, double deviation_m);

  // What was measured and reckoned at `time_s`, linear between samples; of the latest sample from that on.
  // Empty before the history.
  struct Past {
    double time_s = 0;
    EulerAngles attitude;
    Vec3 position_ned_m = Vec3::Zero();
    void archive(Archive& a) { a(time_s, attitude, position_ned_m); }
  };
  static constexpr double kMemory_s = 30;
  std::optional<Past> at(double time_s) const;

  bool has_sample() const { return last_.has_value(); }
  const NavigationSample& last() const { return *last_; }
  // At `time_s`, not before the latest sample: carried on by its velocity.
  Vec3 position_ned_m(double time_s) const;
  Vec3 velocity_ned_mps() const { return velocity_ned_mps_; }
  // Standard deviation of north and of east.
  double deviation_m() const { return deviation_m_; }

  void archive(Archive& a) { a(position_ned_m_, velocity_ned_mps_, deviation_m_, last_, past_); }

 private:
  void move_to(const Eigen::Vector2d& north_east_m);

  NavigatorRules rules_;
  Vec3 position_ned_m_;
  Vec3 velocity_ned_mps_ = Vec3::Zero();
  double deviation_m_;
  std::optional<NavigationSample> last_;
  std::deque<Past> past_;  // ascending
};

}  // namespace halocline::clients
