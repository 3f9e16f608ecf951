// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/autopilot/navigation/attitude_keeper.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/check.h"

namespace halocline::clients {
namespace {

// Standard deviation of an unknown angle, uniform over the circle.
constexpr double kUnknown = std::numbers::pi / std::numbers::sqrt3;

Quaternion turned(const Quaternion& q, const Vec3& turn_body_rad) {
  return (q * rotation_by(turn_body_rad)).normalized();
}

}  // namespace

AttitudeKeeper::AttitudeKeeper(double gyro_bias_radps)
    : gyro_bias_radps_(gyro_bias_radps), heading_deviation_rad_(kUnknown) {
  require(gyro_bias_radps >= 0, "the bias of a gyro is 0 or above");
}

void AttitudeKeeper::add(const AttitudeReading& reading) {
  if (last_s_ && reading.time_s <= *last_s_) return;
  if (reading.attitude) {
    attitude_ = *reading.attitude;
    heading_deviation_rad_ = 0;
  } else if (last_s_) {
    carry_on(reading);
  }
  if (reading.rates_radps) {
    rates_radps_ = *reading.rates_radps;
    rates_s_ = reading.time_s;
  }
  last_s_ = reading.time_s;
}

// Integrates the mean of the latest two rates over the interval: q <- q exp(dt omega / 2).
void AttitudeKeeper::carry_on(const AttitudeReading& reading) {
  const double dt_s = reading.time_s - *last_s_;
  if (!reading.rates_radps && (!rates_s_ || reading.time_s - *rates_s_ > kRatesHold_s)) {
    heading_deviation_rad_ = kUnknown;
    return;
  }
  const Vec3 now = reading.rates_radps.value_or(rates_radps_);
  const Vec3 mean = rates_s_ ? Vec3(0.5 * (rates_radps_ + now)) : now;
  attitude_ = to_euler(turned(to_quaternion(attitude_), dt_s * mean));
  heading_deviation_rad_ = std::min(heading_deviation_rad_ + gyro_bias_radps_ * dt_s, kUnknown);
}

}  // namespace halocline::clients
