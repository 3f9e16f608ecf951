// SPDX-License-Identifier: BSD-3-Clause
// Position by the vehicle's own sensors: dead reckoning between position fixes.
//
// Model: the position is the time integral (trapezium rule) of the velocity over ground where a Doppler log
// measures it, else of the speed through the water along the hull's axis (heading, pitch), as if the water
// were at rest. z is the measured depth.
//
// Uncertainty is a standard deviation sigma, common to both horizontal axes, which grows over a step of time
// dt and length ds by
//
//   log_drift_mps dt     with the speed through the water (unknown current)
//   dvl_drift ds         with the velocity over ground (scale error of the Doppler log, compass error)
//   min(heading_deviation, 1) ds    in addition, while the gyro replaces the compass (attitude_keeper.h)
//
// These are systematic errors, so deviations add up, not variances. A fix of variance R moves the position by
// the Kalman gain, with one variance P = sigma^2 for both axes:
//
//   gain = P / (P + R),  P -> 1 / (1/P + 1/R)
//
// In a current c the error thus grows as c t, and a good fix removes it. A fix that is up to kMemory_s old is
// compared with the position estimated for its instant. Left out: estimation of the current and of the
// compass error, sideslip without a Doppler log.
#pragma once

#include <deque>
#include <optional>

#include "core/archive.h"
#include "core/frames.h"

namespace halocline::clients {

struct NavigatorRules {
  double log_drift_mps = 0.1;    // metres per second by unknown currents, 0 or above
  double dvl_drift = 0.01;       // metres per metre travelled over ground, 0 or above
  double start_deviation_m = 1;  // deviation of the starting position, 0 or above
  // Maximum bias of the gyro that replaces the compass: 36 degrees per hour; 0 or above.
  double gyro_bias_radps = 1.7453292519943296e-4;
};

// Sensor readings of one instant.
struct NavigationSample {
  double time_s = 0;
  EulerAngles attitude;
  double depth_m = 0;                              // used as z
  double water_speed_mps = 0;                      // forward speed through the water
  std::optional<Vec3> ground_velocity_body_mps{};  // from a Doppler log
  double heading_deviation_rad = 0;                // while the compass is unavailable, see attitude_keeper.h

  void archive(Archive& a) {
    a(time_s, attitude, depth_m, water_speed_mps, ground_velocity_body_mps, heading_deviation_rad);
  }
};

class Navigator {
 public:
  // `start_ned_m`: starting position of the vehicle.
  Navigator(const Vec3& start_ned_m, NavigatorRules rules);

  // Adds a sample. Samples must come in order of time; one that is not later than the last is ignored.
  void add(const NavigationSample& sample);
  // Adds a position measured at the latest sample, or at `time_s`. `deviation_m`: standard deviation of
  // each axis, above 0. A fix from before the history is ignored.
  void fix(double north_m, double east_m, double deviation_m);
  void fix(double north_m, double east_m, double deviation_m, double time_s);

  // Replaces the position by that of another estimator that uses all data of this one and more.
  void replace(double north_m, double east_m, double deviation_m);

  // Returns attitude and estimated position at `time_s`, linear between samples; from the latest sample on,
  // those of the latest sample. Empty before the history.
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
  // Returns the position at `time_s`, not before the latest sample: extrapolated by its velocity.
  Vec3 position_ned_m(double time_s) const;
  Vec3 velocity_ned_mps() const { return velocity_ned_mps_; }
  // Standard deviation of the north and of the east component, m.
  double deviation_m() const { return deviation_m_; }

  void archive(Archive& a) { a(position_ned_m_, velocity_ned_mps_, deviation_m_, last_, past_); }

 private:
  void move_to(const Eigen::Vector2d& north_east_m);

  NavigatorRules rules_;
  Vec3 position_ned_m_;
  Vec3 velocity_ned_mps_ = Vec3::Zero();
  double deviation_m_;
  std::optional<NavigationSample> last_;
  std::deque<Past> past_;  // in ascending order of time
};

}  // namespace halocline::clients
