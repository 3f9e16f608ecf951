// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/autopilot/navigation/navigator.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/check.h"

namespace halocline::clients {
namespace {

Vec3 velocity_of(const NavigationSample& sample) {
  const Vec3 body = sample.ground_velocity_body_mps.value_or(Vec3(sample.water_speed_mps, 0, 0));
  return to_quaternion(sample.attitude) * body;
}

}  // namespace

Navigator::Navigator(const Vec3& start_ned_m, NavigatorRules rules)
    : rules_(rules), position_ned_m_(start_ned_m), deviation_m_(rules.start_deviation_m) {
  require(rules.log_drift_mps >= 0 && rules.dvl_drift >= 0 && rules.start_deviation_m >= 0,
          "drifts and the deviation at the start are 0 or above");
}

void Navigator::add(const NavigationSample& sample) {
  if (last_ && sample.time_s <= last_->time_s) return;
  const Vec3 velocity = velocity_of(sample);
  if (last_) {
    const double dt_s = sample.time_s - last_->time_s;
    const Vec3 step = 0.5 * dt_s * (velocity_ned_mps_ + velocity);
    position_ned_m_ += step;
    deviation_m_ += sample.ground_velocity_body_mps ? rules_.dvl_drift * step.head<2>().norm()
                                                    : rules_.log_drift_mps * dt_s;
    deviation_m_ += std::min(sample.heading_deviation_rad, 1.0) * step.head<2>().norm();
  }
  position_ned_m_.z() = sample.depth_m;
  velocity_ned_mps_ = velocity;
  last_ = sample;
  past_.push_back({sample.time_s, sample.attitude, position_ned_m_});
  while (past_.front().time_s < sample.time_s - kMemory_s) past_.pop_front();
}

std::optional<Navigator::Past> Navigator::at(double time_s) const {
  if (past_.empty() || time_s < past_.front().time_s) return std::nullopt;
  const auto after = std::upper_bound(past_.begin(), past_.end(), time_s,
                                      [](double t, const Past& past) { return t < past.time_s; });
  const Past& before = *(after - 1);
  if (after == past_.end()) return before;
  const double share = (time_s - before.time_s) / (after->time_s - before.time_s);
  const auto turned = [&](double from, double to) {
    return from + share * std::remainder(to - from, 2 * std::numbers::pi);
  };
  return Past{time_s,
              {turned(before.attitude.roll, after->attitude.roll),
               turned(before.attitude.pitch, after->attitude.pitch),
               turned(before.attitude.yaw, after->attitude.yaw)},
              before.position_ned_m + share * (after->position_ned_m - before.position_ned_m)};
}

// A fix of the past is moved to the present by the path since then, as estimated by dead reckoning.
void Navigator::fix(double north_m, double east_m, double deviation_m, double time_s) {
  const auto then = at(time_s);
  if (!then) return;
  const Eigen::Vector2d way = (position_ned_m_ - then->position_ned_m).head<2>();
  fix(north_m + way.x(), east_m + way.y(), deviation_m);
}

// Kalman update with one variance P for both axes and the variance R of the fix:
//
//   gain = P / (P + R),  p <- p + gain (fix - p),  P <- P (1 - gain)
void Navigator::fix(double north_m, double east_m, double deviation_m) {
  require(deviation_m > 0, "the deviation of a fix is above 0");
  const double p = deviation_m_ * deviation_m_, r = deviation_m * deviation_m;
  const double gain = p / (p + r);
  move_to(position_ned_m_.head<2>() + gain * (Eigen::Vector2d(north_m, east_m) - position_ned_m_.head<2>()));
  deviation_m_ = std::sqrt(p * (1 - gain));
}

// Moves the present position, and the history by the same correction.
void Navigator::move_to(const Eigen::Vector2d& north_east_m) {
  const Eigen::Vector2d correction = north_east_m - position_ned_m_.head<2>();
  position_ned_m_.head<2>() = north_east_m;
  for (Past& past : past_) past.position_ned_m.head<2>() += correction;
}

void Navigator::replace(double north_m, double east_m, double deviation_m) {
  require(deviation_m >= 0, "the deviation of a place is 0 or above");
  move_to({north_m, east_m});
  deviation_m_ = deviation_m;
}

Vec3 Navigator::position_ned_m(double time_s) const {
  return last_ ? Vec3(position_ned_m_ + (time_s - last_->time_s) * velocity_ned_mps_) : position_ned_m_;
}

}  // namespace halocline::clients
