// SPDX-License-Identifier: BSD-3-Clause
// Heading, pitch and roll by the compass, integrated from the gyro while the compass is unavailable.
//
// Model: the compass's reading is taken as it is; until the next one the attitude turns with the angular
// rates measured, as q' = 1/2 q (0, omega) with the mean of two samples (error of the third order of the turn
// between them). A constant bias b of the gyro turns the heading away by b t on a level course; its pitch and
// roll drift likewise. The heading's uncertainty, beyond the compass's own, grows by `gyro_bias_radps` times
// the time since the compass, up to that of a heading of which nothing is known, pi / sqrt(3). Rates older
// than kRatesHold_s count as lost: the attitude stays, and the heading is held to be unknown. Left out:
// estimating the bias while the compass is there, the pull of gravity on pitch and roll.
#pragma once

#include <optional>

#include "core/archive.h"
#include "core/frames.h"

namespace halocline::clients {

struct AttitudeReading {
  double time_s = 0;
  std::optional<EulerAngles> attitude{};  // empty: the compass is unavailable
  std::optional<Vec3> rates_radps{};      // about forward, starboard, down; empty: the gyro is unavailable
};

class AttitudeKeeper {
 public:
  static constexpr double kRatesHold_s = 1;

  // `gyro_bias_radps`: of the gyro at most, 0 or above.
  explicit AttitudeKeeper(double gyro_bias_radps);

  // Readings come in order of time; one that is not later than the last is ignored.
  void add(const AttitudeReading& reading);

  // Level and northwards before the first reading of the compass.
  const EulerAngles& attitude() const { return attitude_; }
  // What the heading may be off beyond the compass's own error, radians; 0 while the compass measures it.
  double heading_deviation_rad() const { return heading_deviation_rad_; }
  bool by_compass() const { return by_compass_; }

  void archive(Archive& a) {
    a(attitude_, heading_deviation_rad_, by_compass_, last_s_, rates_s_, rates_radps_);
  }

 private:
  void carry_on(const AttitudeReading& reading);

  double gyro_bias_radps_;
  EulerAngles attitude_;
  double heading_deviation_rad_;
  bool by_compass_ = false;
  std::optional<double> last_s_;   // of the last reading
  std::optional<double> rates_s_;  // of the last rates
  Vec3 rates_radps_ = Vec3::Zero();
};

}  // namespace halocline::clients
