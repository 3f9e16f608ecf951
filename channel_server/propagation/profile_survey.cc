#include "channel_server/propagation/profile_survey.h"

#include <algorithm>
#include <cmath>

#include "acoustics/sea/sound_speed_profile.h"
#include "core/check.h"

namespace halocline::channel_server {
namespace {

// The least water a bottom profile knows, m: what land counts as, and what is left under an end.
constexpr double kMinWaterM = 0.1;

Vec3 place_of(const LatticeCell& cell, const ProfileRule& rule) {
  return {static_cast<double>(cell.north) * rule.reuse_distance_m,
          static_cast<double>(cell.east) * rule.reuse_distance_m, 0};
}

int samples_over(double length_m, const ProfileRule& rule) {
  const double wanted = std::ceil(length_m / rule.spacing_m) + 1;
  const double allowed = std::clamp<double>(wanted, ProfileRule::kMinSamples, ProfileRule::kMaxSamples);
  return static_cast<int>(allowed);
}

}  // namespace

LatticeCell cell_of(const Vec3& position_ned_m, const ProfileRule& rule) {
  return {std::llround(position_ned_m.x() / rule.reuse_distance_m),
          std::llround(position_ned_m.y() / rule.reuse_distance_m)};
}

CellPair cells_of(const Vec3& from_ned_m, const Vec3& to_ned_m, const ProfileRule& rule) {
  return {cell_of(from_ned_m, rule), cell_of(to_ned_m, rule)};
}

ProfileSurvey::ProfileSurvey(const CellPair& cells, const ProfileRule& rule) : cells_(cells) {
  require_in_range(rule.reuse_distance_m, 0.1, 1000, "distance of reuse of bottom profiles", "m");
  require_in_range(rule.spacing_m, 1, 1000, "spacing of bottom profiles", "m");
  const Vec3 from = place_of(cells.from, rule), way = place_of(cells.to, rule) - from;
  const int count = samples_over(way.norm(), rule);
  for (int i = 0; i < count; ++i) places_.emplace_back(from + (static_cast<double>(i) / (count - 1)) * way);
}

std::optional<RayKind> ProfileSurvey::next_query() const {
  return taken_ ? std::nullopt : std::optional(RayKind::kDepths);
}

std::vector<TerrainRay> ProfileSurvey::rays() const {
  std::vector<TerrainRay> rays;
  for (const Vec3& place : places_) rays.push_back(depth_ray(place));
  return rays;
}

void ProfileSurvey::take(std::span<const RayAnswer> answers) {
  require(answers.size() == places_.size(), "one answer a depth");
  taken_ = true;
  SeabedProfile seabed_z_m;
  for (const RayAnswer& answer : answers) {
    if (answer.kind != RayAnswer::Kind::kHit) return;
    seabed_z_m.push_back(answer.result_m);
  }
  profile_ = std::make_shared<const SeabedProfile>(std::move(seabed_z_m));
}

acoustics::BottomProfile bottom_under(const SeabedProfile& seabed, const acoustics::RayLink& link,
                                      double sea_surface_z_m) {
  std::vector<acoustics::ProfiledDepth> points;
  const double last = static_cast<double>(seabed.size() - 1);
  for (std::size_t i = 0; i < seabed.size(); ++i) {
    const double depth = std::clamp(seabed[i] - sea_surface_z_m, kMinWaterM, acoustics::kDeepestWater);
    points.push_back({link.range_m * static_cast<double>(i) / last, depth});
  }
  points.front().depth_m = std::max(points.front().depth_m, link.source_depth_m + kMinWaterM);
  points.back().depth_m = std::max(points.back().depth_m, link.receiver_depth_m + kMinWaterM);
  if (points[1].range_m > points[0].range_m) return acoustics::BottomProfile(std::move(points));
  // One right above the other: there is nothing to stretch.
  return acoustics::BottomProfile::flat(std::max(points.front().depth_m, points.back().depth_m));
}

bool cuts_straight_line(const acoustics::BottomProfile& bottom, const acoustics::RayLink& link) {
  return std::any_of(bottom.points().begin(), bottom.points().end(), [&](const auto& point) {
    const double share = link.range_m > 0 ? point.range_m / link.range_m : 0;
    return link.source_depth_m + share * (link.receiver_depth_m - link.source_depth_m) >= point.depth_m;
  });
}

}  // namespace halocline::channel_server
