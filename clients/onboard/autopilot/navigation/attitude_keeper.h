// SPDX-License-Identifier: BSD-3-Clause
// Attitude by the compass, and by integration of the gyro while the compass is unavailable.
//
// Model: a compass reading is used unchanged. Until the next one the attitude q is integrated with the mean
// omega of the angular rates of two samples (error of third order in the rotation between them):
//
//   q' = 1/2 q (0, omega)
//
// A constant gyro bias b makes the heading drift by b t on a level course; pitch and roll drift likewise. The
// heading's uncertainty beyond the compass's own error grows by `gyro_bias_radps` times the time since the
// last compass reading, up to that of an unknown heading, pi / sqrt(3). Rates older than kRatesHold_s count
// as lost: the attitude is then held, and the heading is taken as unknown. Left out: estimation of the bias
// while the compass works, correction of pitch and roll by the direction of gravity.
#pragma once

#include <optional>

#include "core/archive.h"
#include "core/frames.h"

namespace halocline::clients {

struct AttitudeReading {
  double time_s = 0;
  std::optional<EulerAngles> attitude{};  // empty: the compass is unavailable
  std::optional<Vec3> rates_radps{};      // about forward, starboard, down; empty: no gyro
};

class AttitudeKeeper {
 public:
  static constexpr double kRatesHold_s = 1;

  // `gyro_bias_radps`: largest bias of the gyro, 0 or above.
  explicit AttitudeKeeper(double gyro_bias_radps);

  // Adds a reading. Readings must come in order of time; one that is not later than the last is ignored.
  void add(const AttitudeReading& reading);

  // Level and pointing north before the first reading of the compass.
  const EulerAngles& attitude() const { return attitude_; }
  // Returns the heading's uncertainty beyond the compass's own error, rad; 0 while the compass works.
  double heading_deviation_rad() const { return heading_deviation_rad_; }

  void archive(Archive& a) { a(attitude_, heading_deviation_rad_, last_s_, rates_s_, rates_radps_); }

 private:
  void carry_on(const AttitudeReading& reading);

  double gyro_bias_radps_;
  EulerAngles attitude_;
  double heading_deviation_rad_;
  std::optional<double> last_s_;   // time of the latest reading
  std::optional<double> rates_s_;  // time of the latest rates
  Vec3 rates_radps_ = Vec3::Zero();
};

}  // namespace halocline::clients
