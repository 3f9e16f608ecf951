#include "clients/autopilot/navigator.h"

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
  require(rules.log_drift_mps >= 0 && rules.ground_drift >= 0 && rules.start_deviation_m >= 0,
          "drifts and the deviation at the start are 0 or above");
}

void Navigator::add(const NavigationSample& sample) {
  if (last_ && sample.time_s <= last_->time_s) return;
  const Vec3 velocity = velocity_of(sample);
  if (last_) {
    const double dt_s = sample.time_s - last_->time_s;
    const Vec3 step = 0.5 * dt_s * (velocity_ned_mps_ + velocity);
    position_ned_m_ += step;
    deviation_m_ += sample.ground_velocity_body_mps ? rules_.ground_drift * step.head<2>().norm()
                                                    : rules_.log_drift_mps * dt_s;
  }
  position_ned_m_.z() = sample.depth_m;
  velocity_ned_mps_ = velocity;
  last_ = sample;
}

void Navigator::fix(double north_m, double east_m, double deviation_m) {
  require(deviation_m > 0, "the deviation of a fix is above 0");
  const double p = deviation_m_ * deviation_m_, r = deviation_m * deviation_m;
  const double gain = p / (p + r);
  const Eigen::Vector2d here = position_ned_m_.head<2>();
  position_ned_m_.head<2>() = here + gain * (Eigen::Vector2d(north_m, east_m) - here);
  deviation_m_ = std::sqrt(p * (1 - gain));
}

void Navigator::replace(double north_m, double east_m, double deviation_m) {
  require(deviation_m >= 0, "the deviation of a place is 0 or above");
  position_ned_m_.head<2>() = Eigen::Vector2d(north_m, east_m);
  deviation_m_ = deviation_m;
}

Vec3 Navigator::position_ned_m(double time_s) const {
  return last_ ? Vec3(position_ned_m_ + (time_s - last_->time_s) * velocity_ned_mps_) : position_ned_m_;
}

}  // namespace halocline::clients
