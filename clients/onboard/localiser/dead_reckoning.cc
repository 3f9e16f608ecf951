// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/localiser/dead_reckoning.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.h"

namespace halocline::clients {

// Trapezium rule over the interval dt since the last measurement:
//
//   path <- path + dt (v_before + v) / 2,  v = speed cos(pitch) (cos(heading), sin(heading))
void DeadReckoning::take(const OwnMotion& motion) {
  const double horizontal_mps = motion.water_speed_mps * elementary::cos(motion.pitch_rad);
  Point point{motion.at,
              Vec2::Zero(),
              horizontal_mps * Vec2(elementary::cos(motion.heading_rad), elementary::sin(motion.heading_rad)),
              motion.depth_m,
              motion.heading_rad,
              0};
  if (!empty()) {
    const Point& before = points_.back();
    if (point.at <= before.at) return;
    const double seconds = (point.at - before.at).seconds();
    point.gone_ne_m = before.gone_ne_m + 0.5 * seconds * (before.velocity_ne_mps + point.velocity_ne_mps);
    const double turn_rad = std::remainder(point.heading_rad - before.heading_rad, 2 * std::numbers::pi);
    point.turned_rad = before.turned_rad + std::abs(turn_rad);
  }
  points_.push_back(point);
  while (point.at - points_.front().at > kRemembered) points_.pop_front();
}

std::pair<std::size_t, double> DeadReckoning::place_of(SimTime at) const {
  const auto after = std::upper_bound(points_.begin(), points_.end(), at,
                                      [](SimTime time, const Point& point) { return time < point.at; });
  const auto index = static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - points_.begin() - 1, 0));
  if (after == points_.begin() || after == points_.end()) return {index, 0.0};
  return {index, (at - points_[index].at).seconds() / (after->at - points_[index].at).seconds()};
}

Vec2 DeadReckoning::gone_ne_m(SimTime at) const {
  const auto [index, share] = place_of(at);
  const Point& point = points_[index];
  if (index + 1 < points_.size())
    return point.gone_ne_m + share * (points_[index + 1].gone_ne_m - point.gone_ne_m);
  return point.gone_ne_m + (at - point.at).seconds() * point.velocity_ne_mps;
}

double DeadReckoning::depth_m(SimTime at) const {
  const auto [index, share] = place_of(at);
  if (index + 1 >= points_.size()) return points_[index].depth_m;
  return points_[index].depth_m + share * (points_[index + 1].depth_m - points_[index].depth_m);
}

double DeadReckoning::turned_rad(SimTime at) const {
  const auto [index, share] = place_of(at);
  if (index + 1 >= points_.size()) return points_[index].turned_rad;
  return points_[index].turned_rad + share * (points_[index + 1].turned_rad - points_[index].turned_rad);
}

}  // namespace halocline::clients
