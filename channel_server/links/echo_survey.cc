// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/links/echo_survey.h"

#include <utility>

#include "core/check.h"

namespace halocline::channel_server {
namespace {

// An end closer to a bottom point than this is on it, so nothing can stand between them.
constexpr double kOnTheBottomM = 2 * EchoSurvey::kShortOfBottomM;

TerrainRay way_to(const Vec3& end, const Vec3& bottom) {
  const Vec3 way = bottom - end;
  if (way.norm() < kOnTheBottomM) return {end, -Vec3::UnitZ(), EchoSurvey::kShortOfBottomM};
  return {end, way, way.norm() - EchoSurvey::kShortOfBottomM};
}

bool is_told(RayAnswer::Kind kind) {
  return kind == RayAnswer::Kind::kHit || kind == RayAnswer::Kind::kMiss ||
         kind == RayAnswer::Kind::kBelowBottom;
}

// A hit blocks the way. So does an end below the bottom, which receives nothing from the bottom point.
bool is_blocked(RayAnswer::Kind kind) { return kind != RayAnswer::Kind::kMiss; }

}  // namespace

EchoSurvey::EchoSurvey(const Vec3& from_ned_m, const Vec3& to_ned_m, int point_count)
    : from_(from_ned_m), to_(to_ned_m) {
  for (const double fraction : acoustics::bottom_point_fractions(point_count)) {
    asked_.push_back(from_ + fraction * (to_ - from_));
  }
}

std::optional<RayKind> EchoSurvey::next_query() const {
  if (stage_ == Stage::kDepths) return RayKind::kDepths;
  return stage_ == Stage::kWays && !bottom_.empty() ? std::optional(RayKind::kWays) : std::nullopt;
}

void EchoSurvey::take(std::span<const RayAnswer> answers) {
  stage_ == Stage::kDepths ? take_depths(answers) : take_ways(answers);
}

std::vector<TerrainRay> EchoSurvey::depth_rays() const {
  std::vector<TerrainRay> rays;
  for (const Vec3& place : asked_) rays.push_back(depth_ray(place));
  return rays;
}

void EchoSurvey::take_depths(std::span<const RayAnswer> answers) {
  require(answers.size() == asked_.size(), "one answer a depth");
  bottom_.clear();
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (answers[i].kind != RayAnswer::Kind::kHit) continue;
    bottom_.push_back({Vec3(asked_[i].x(), asked_[i].y(), answers[i].result_m), false, false});
  }
  complete_ = bottom_.size() == asked_.size();
  stage_ = Stage::kWays;
}

std::vector<TerrainRay> EchoSurvey::way_rays() const {
  std::vector<TerrainRay> rays;
  for (const acoustics::BottomPoint& point : bottom_) {
    rays.push_back(way_to(from_, point.position_ned_m));
    rays.push_back(way_to(to_, point.position_ned_m));
  }
  return rays;
}

void EchoSurvey::take_ways(std::span<const RayAnswer> answers) {
  require(answers.size() == 2 * bottom_.size(), "two answers a bottom point");
  for (std::size_t i = 0; i < bottom_.size(); ++i) {
    const auto from = answers[2 * i].kind, to = answers[2 * i + 1].kind;
    bottom_[i].blocked_from_transmitter = is_blocked(from);
    bottom_[i].blocked_to_receiver = is_blocked(to);
    complete_ = complete_ && is_told(from) && is_told(to);
  }
  stage_ = Stage::kDone;
}

Multipath multipath_of(const EchoSurvey& survey, bool reversed, SimTime at, Propagation& propagation,
                       const acoustics::Modem& transmitter, const acoustics::Modem& receiver) {
  std::vector<acoustics::BottomPoint> points = survey.bottom();
  Vec3 from = survey.from_ned_m(), to = survey.to_ned_m();
  if (reversed) {
    std::swap(from, to);
    for (auto& point : points) std::swap(point.blocked_from_transmitter, point.blocked_to_receiver);
  }
  if (propagation.echo_is_receivable(at, transmitter, receiver, from, to, points)) return Multipath::kLikely;
  return survey.complete() ? Multipath::kUnlikely : Multipath::kUnknown;
}

}  // namespace halocline::channel_server
