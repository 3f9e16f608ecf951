// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/autopilot/vehicle_pilot.h"

#include <algorithm>

#include "core/elementary.h"

namespace halocline::clients {
namespace {

constexpr double kCarrotM = 10;       // distance along a course of the point that thrusters steer for
constexpr double kMinSpeedMps = 0.3;  // minimum water speed of a follower, for fins to be effective

Measured measured_of(const Situation& s) {
  return {s.position_ned_m.z(), s.attitude.yaw,   s.attitude.pitch,
          s.pitch_rate_radps,   s.yaw_rate_radps, s.water_speed_mps};
}

}  // namespace

VehiclePilot::VehiclePilot(Plan plan, SeabedRules seabed_rules)
    : plan_(std::move(plan)), seabed_rules_(seabed_rules) {
  restart();
}

void VehiclePilot::on_leader_report(const std::string& leader, const LeaderReport& report) {
  for (auto& follower : followers_) {
    if (follower && follower->formation().leader == leader) follower->on_report(report);
  }
}

SetPoints VehiclePilot::steer_for(const Situation& situation) {
  const Vec3& position = situation.position_ned_m;
  if (!progress_) progress_ = begin(position, situation.time_s);
  progress_ = advance(plan_, *progress_, position, situation.time_s);
  return above_seabed(seabed_rules_, seabed_, situation.time_s, position.z(), planned(situation));
}

SetPoints VehiclePilot::planned(const Situation& situation) {
  if (const LinkSeeker* seeker = this->seeker()) return circling(*seeker, situation.position_ned_m);
  auto& follower = followers_[progress_->index];
  if (!follower || progress_->ended) return set_points(plan_, *progress_, situation.position_ned_m);
  SetPoints points = follower->steer_for(situation.time_s, situation.position_ned_m);
  // The follower's set speed is over ground; the propeller needs the speed through the water.
  const Vec3 bow(elementary::cos(situation.attitude.yaw), elementary::sin(situation.attitude.yaw), 0);
  points.speed_mps += situation.water_speed_mps - situation.velocity_ned_mps.dot(bow);
  points.speed_mps = std::max(points.speed_mps, kMinSpeedMps);
  return points;
}

LinkSeeker* VehiclePilot::seeker() {
  if (!progress_ || progress_->ended || !seekers_[progress_->index]) return nullptr;
  return &*seekers_[progress_->index];
}

// Fins circle about the chosen place, thrusters steer straight to it.
SetPoints VehiclePilot::circling(const LinkSeeker& seeker, const Vec3& position_ned_m) const {
  const Behaviour& behaviour = plan_.behaviours[progress_->index];
  return {.course_rad = course_on_circle(seeker.chosen(), behaviour.radius_m,
                                         behaviour.sense == Sense::kClockwise, position_ned_m),
          .z_ned_m = seeker.chosen().z(),
          .speed_mps = plan_.routes[progress_->index].speed_mps,
          .station_ned_m = seeker.chosen()};
}

std::optional<FollowPhase> VehiclePilot::follow_phase() const {
  if (!progress_ || progress_->ended || !followers_[progress_->index]) return std::nullopt;
  return followers_[progress_->index]->phase();
}

ActuatorCommand VehiclePilot::with_fins(const Gains& gains, const SetPoints& points, const Situation& s,
                                        double dt_s) {
  return command(gains, points, measured_of(s), dt_s, integrals_);
}

ActuatorCommand VehiclePilot::by_buoyancy(const GlideGains& glide, const Gains& gains,
                                          const SetPoints& points, const Situation& s, double dt_s) {
  return glide_command(glide, gains, points, measured_of(s), dt_s, glide_);
}

std::array<double, 4> VehiclePilot::with_thrusters(const HoverGains& gains, const SetPoints& points,
                                                   const Situation& s, double dt_s) {
  if (!points.propel) return {};
  const Vec3 ahead =
      kCarrotM * Vec3(elementary::cos(points.course_rad), elementary::sin(points.course_rad), 0);
  StationPoint point{points.station_ned_m.value_or(s.position_ned_m + ahead), points.speed_mps};
  point.position_ned_m.z() = points.z_ned_m;
  const HoverMeasured measured{s.position_ned_m, s.velocity_ned_mps, s.attitude.yaw,
                               s.attitude.pitch, s.pitch_rate_radps, s.yaw_rate_radps};
  return hover_command(gains, point, measured, dt_s, hover_integrals_);
}

Activity VehiclePilot::activity() const {
  if (!progress_) return Activity::kWaitingForState;
  if (progress_->ended || progress_->route.at_end) {
    if (plan_.at_end == AtEnd::kSurface) return Activity::kSurfacing;
    return plan_.at_end == AtEnd::kStop ? Activity::kFinished : Activity::kHolding;
  }
  if (const auto phase = follow_phase()) {
    switch (*phase) {
      case FollowPhase::kWaiting:
        return Activity::kWaitingForLeader;
      case FollowPhase::kFollowing:
        return Activity::kFollowingLeader;
      case FollowPhase::kKeepingCourse:
        return Activity::kLeaderLost;
      case FollowPhase::kSafe:
        return Activity::kCirclingSafely;
    }
  }
  const BehaviourKind kind = plan_.behaviours[progress_->index].kind;
  if (kind == BehaviourKind::kWait) return Activity::kWaiting;
  if (kind == BehaviourKind::kSeekLink) return Activity::kSeekingLink;
  if (kind == BehaviourKind::kHeading) return Activity::kKeepingHeading;
  return kind == BehaviourKind::kLoiter ? Activity::kLoitering : Activity::kFollowingLeg;
}

std::string VehiclePilot::text() const {
  if (!progress_) return "waiting for its first state";
  if (progress_->ended || progress_->route.at_end) return "mission finished";
  if (const auto phase = follow_phase()) return to_text(*phase);
  const BehaviourKind kind = plan_.behaviours[progress_->index].kind;
  const std::string to_waypoint = "to waypoint " + std::to_string(progress_->route.target);
  if (kind == BehaviourKind::kHeading) return "keeps a heading";
  if (kind == BehaviourKind::kLoiter) return "circles";
  if (kind == BehaviourKind::kWait) return "waits";
  if (kind == BehaviourKind::kSeekLink) return "seeks where it is best heard";
  return kind == BehaviourKind::kSurvey ? "surveys, " + to_waypoint : to_waypoint;
}

void VehiclePilot::archive(Archive& a) {
  a(seabed_, progress_, integrals_, hover_integrals_, glide_);
  for (auto& follower : followers_) {
    if (follower) a(*follower);
  }
  for (auto& seeker : seekers_) {
    if (seeker) a(*seeker);
  }
}

void VehiclePilot::restart() {
  seabed_.clear();
  followers_.clear();
  seekers_.clear();
  for (const Behaviour& behaviour : plan_.behaviours) {
    const bool follows = behaviour.kind == BehaviourKind::kFollow;
    followers_.push_back(follows ? std::optional(Follower(behaviour.formation, behaviour.radius_m))
                                 : std::nullopt);
    const bool seeks = behaviour.kind == BehaviourKind::kSeekLink;
    seekers_.push_back(seeks ? std::optional(LinkSeeker(behaviour)) : std::nullopt);
  }
  progress_.reset();
  integrals_ = {};
  hover_integrals_ = {};
  glide_ = {};
}

}  // namespace halocline::clients
