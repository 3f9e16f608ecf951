// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/autopilot/formation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/check.h"
#include "core/elementary.h"

namespace halocline::clients {
namespace {

constexpr std::uint8_t kKind = 0xF1;
constexpr double kPerMetre = 10, kPerMps = 1000, kTurn = 65536;
constexpr std::int64_t kLargest24 = (1 << 23) - 1, kTimeSpanMs = 65536;
constexpr double kLookaheadM = 20;     // look-ahead distance for the cross-track error
constexpr double kCatchUpPerS = 0.06;  // 1/s, speed added per metre of along-track error
constexpr double kSlowest = 0.5;       // minimum speed, as a fraction of the leader's

void put(std::vector<std::uint8_t>& bytes, std::int64_t value, int count) {
  for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::uint8_t>((value >> (8 * i)) & 0xff));
}

std::int64_t get(std::span<const std::uint8_t> bytes, std::size_t at, std::size_t count) {
  std::int64_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value |= static_cast<std::int64_t>(bytes[at + i]) << (8 * i);
  return value;
}

std::int64_t signed24(std::int64_t value) { return value > kLargest24 ? value - (1 << 24) : value; }

std::uint8_t check_of(std::span<const std::uint8_t> bytes) {
  unsigned sum = 0;
  for (std::size_t i = 0; i + 1 < kReportBytes; ++i) sum += bytes[i];
  return static_cast<std::uint8_t>(~sum & 0xff);
}

Vec3 along(double course_rad) { return {elementary::cos(course_rad), elementary::sin(course_rad), 0}; }

}  // namespace

std::vector<std::uint8_t> encode_report(const LeaderReport& report) {
  std::vector<std::uint8_t> bytes{kKind};
  for (const double metres : report.position_ned_m) {
    const auto value = std::llround(metres * kPerMetre);
    require(std::abs(value) <= kLargest24, "a position in a report lies within 838 km of the origin");
    put(bytes, value, 3);
  }
  const auto speed = std::llround(report.speed_mps * kPerMps);
  require(speed >= 0 && speed <= 65535, "a speed in a report is 0 to 65 m/s");
  put(bytes, std::llround(report.course_rad / (2 * std::numbers::pi) * kTurn), 2);
  put(bytes, speed, 2);
  put(bytes, std::llround(report.time_s * 1000) % kTimeSpanMs, 2);
  bytes.push_back(0);
  bytes.back() = check_of(bytes);
  return bytes;
}

std::optional<LeaderReport> decode_report(std::span<const std::uint8_t> payload, double received_s) {
  if (payload.size() != kReportBytes || payload[0] != kKind || payload.back() != check_of(payload))
    return std::nullopt;
  LeaderReport report;
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(1 + 3 * i);
    report.position_ned_m[i] = static_cast<double>(signed24(get(payload, at, 3))) / kPerMetre;
  }
  report.course_rad = wrapped(static_cast<double>(get(payload, 10, 2)) / kTurn * 2 * std::numbers::pi);
  report.speed_mps = static_cast<double>(get(payload, 12, 2)) / kPerMps;
  // The instant in a report is rounded to a millisecond, by up to half a millisecond past its making. A
  // travel time is longer than that, so the age never wraps round.
  const std::int64_t received_ms = std::llround(received_s * 1000);
  const std::int64_t age_ms = ((received_ms - get(payload, 14, 2)) % kTimeSpanMs + kTimeSpanMs) % kTimeSpanMs;
  report.time_s = static_cast<double>(received_ms - age_ms) / 1000;
  return report;
}

std::string to_text(FollowPhase phase) {
  switch (phase) {
    case FollowPhase::kWaiting:
      return "no report of its leader yet: circles";
    case FollowPhase::kFollowing:
      return "follows its leader";
    case FollowPhase::kKeepingCourse:
      return "leader lost: keeps its course";
    case FollowPhase::kSafe:
      return "leader lost: circles at its safe depth";
  }
  return "";
}

void Follower::on_report(const LeaderReport& report) {
  if (!report_ || report.time_s > report_->time_s) report_ = report;
}

FollowPhase Follower::phase_at(double time_s) const {
  if (!report_) return FollowPhase::kWaiting;
  const double age_s = time_s - report_->time_s;
  if (age_s <= formation_.fresh_for_s) return FollowPhase::kFollowing;
  return age_s <= formation_.fresh_for_s + formation_.keep_course_s ? FollowPhase::kKeepingCourse
                                                                    : FollowPhase::kSafe;
}

// Set points for the follower's place, with e_across and e_along the place relative to the follower, resolved
// to starboard of and along the leader's course:
//
//   course = course_leader + atan(e_across / lookahead)
//   speed  = clip(speed_leader + gain e_along)
SetPoints Follower::beside_leader(double time_s, const Vec3& position_ned_m) const {
  const Vec3 ahead = along(report_->course_rad), starboard(-ahead.y(), ahead.x(), 0);
  const Vec3 place = report_->position_ned_m + (time_s - report_->time_s) * report_->speed_mps * ahead +
                     formation_.along_m * ahead + formation_.across_m * starboard;
  const Vec3 error = place - position_ned_m;
  SetPoints points{.z_ned_m = report_->position_ned_m.z() + formation_.below_m};
  points.course_rad = wrapped(report_->course_rad + elementary::atan(error.dot(starboard) / kLookaheadM));
  const double slowest = std::min(kSlowest * report_->speed_mps, formation_.max_speed_mps);
  points.speed_mps =
      std::clamp(report_->speed_mps + kCatchUpPerS * error.dot(ahead), slowest, formation_.max_speed_mps);
  return points;
}

SetPoints Follower::steer_for(double time_s, const Vec3& position_ned_m) {
  phase_ = phase_at(time_s);
  if (phase_ == FollowPhase::kFollowing) {
    safe_center_.reset();
    return beside_leader(time_s, position_ned_m);
  }
  if (phase_ == FollowPhase::kKeepingCourse) {
    return {.course_rad = report_->course_rad,
            .z_ned_m = report_->position_ned_m.z() + formation_.below_m,
            .speed_mps = std::min(report_->speed_mps, formation_.max_speed_mps)};
  }
  if (!safe_center_) safe_center_ = position_ned_m;
  return {.course_rad = course_on_circle(*safe_center_, radius_m_, true, position_ned_m),
          .z_ned_m = formation_.safe_depth_m,
          .speed_mps = formation_.safe_speed_mps};
}

}  // namespace halocline::clients
