// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/autopilot/seabed_ahead.h"

#include <algorithm>

#include "core/elementary.h"

namespace halocline::clients {
namespace {

// Set depth below the vehicle while it descends to a height and its altimeter does not reach the seabed yet.
constexpr double kBlindDescentM = 4;
constexpr double kClearlyBelowM = 0.5;  // below the minimum height: more than a control error
constexpr double kPullUpRadPerM = 0.3;  // a metre below the minimum height demands about the maximum pitch

}  // namespace

// Adds the point of the seabed at the altitude a along the body's down axis:
//
//   path = path of the vehicle + a sin(pitch) cos(roll)
//   z    = z of the vehicle + a cos(pitch) cos(roll)
void SeabedAhead::add(const AltimeterSample& sample) {
  if (last_) way_m_ += (sample.position_ned_m - last_->position_ned_m).head<2>().norm();
  last_ = sample;
  if (sample.has_echo) {
    const double upright = elementary::cos(sample.attitude.pitch) * elementary::cos(sample.attitude.roll);
    const double forward = elementary::sin(sample.attitude.pitch) * elementary::cos(sample.attitude.roll);
    points_.push_back({way_m_ + sample.altitude_m * forward,
                       sample.position_ned_m.z() + sample.altitude_m * upright, sample.time_s});
  }
  const auto is_old = [&](const Point& p) {
    return p.way_m < way_m_ - kWindowM || p.time_s < sample.time_s - 60;
  };
  while (points_.size() > 1 && is_old(points_.front())) points_.pop_front();
}

// Least-squares line through the points (s, z): slope = cov(s, z) / var(s).
std::optional<SeabedLine> SeabedAhead::line(double time_s) const {
  if (points_.empty() || time_s - points_.back().time_s > kOldestS) return std::nullopt;
  double mean_way = 0, mean_z = 0;
  for (const Point& p : points_) {
    mean_way += p.way_m / static_cast<double>(points_.size());
    mean_z += p.z_ned_m / static_cast<double>(points_.size());
  }
  double covariance = 0, variance = 0;
  for (const Point& p : points_) {
    covariance += (p.way_m - mean_way) * (p.z_ned_m - mean_z);
    variance += (p.way_m - mean_way) * (p.way_m - mean_way);
  }
  // The points have a standard deviation of less than half a metre along the path, too little to determine a
  // slope.
  const bool spread = variance > 0.25 * static_cast<double>(points_.size());
  const double slope = spread ? covariance / variance : 0;
  const double z = spread ? mean_z + slope * (way_m_ - mean_way) : points_.back().z_ned_m;
  return SeabedLine{z, slope, points_.back().time_s};
}

bool SeabedAhead::sees_no_bottom(double time_s) const {
  return last_ && !last_->has_echo && time_s - last_->time_s <= kOldestS && !line(time_s);
}

SetPoints above_seabed(const SeabedRules& rules, const SeabedAhead& seabed, double time_s, double z_ned_m,
                       SetPoints points) {
  const bool keeps_height = points.altitude_m > 0;
  if (keeps_height) points.depth_rule = DepthRule::kByAltitude;
  const auto line = seabed.line(time_s);
  if (!line) {
    if (!keeps_height) return points;
    const bool descends = seabed.sees_no_bottom(time_s);
    if (descends) points.depth_rule = DepthRule::kDescending;
    points.z_ned_m = std::min(z_ned_m + (descends ? kBlindDescentM : 0), points.max_z_ned_m);
    return points;
  }
  const double shallowest = std::min(line->z_ned_m, line->z_ned_m + line->slope * rules.ahead_m);
  if (keeps_height) {
    const double wanted = shallowest - std::max(points.altitude_m, rules.min_altitude_m);
    points.z_ned_m = std::min(wanted, points.max_z_ned_m);
    if (wanted <= points.max_z_ned_m) points.climb_rad = -elementary::atan(line->slope);
  }
  const double floor_z = shallowest - rules.min_altitude_m;
  if (points.z_ned_m > floor_z || z_ned_m > floor_z + kClearlyBelowM)
    points.depth_rule = DepthRule::kAvoidingSeabed;
  if (points.z_ned_m >= floor_z) {
    points.z_ned_m = floor_z;
    points.climb_rad = -elementary::atan(line->slope);
  }
  points.climb_rad += kPullUpRadPerM * std::max(z_ned_m - floor_z, 0.0);
  return points;
}

}  // namespace halocline::clients
