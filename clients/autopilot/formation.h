// SPDX-License-Identifier: BSD-3-Clause
// Formation keeping: follows a place beside a leader by its acoustic reports, with a fallback when they stop.
//
// A report is 17 bytes, little-endian, small enough for the slowest modem:
//
//   0      kind, 0xF1
//   1-3    north, decimetres, signed          4-6  east         7-9  z
//   10-11  course over ground, turns / 65536, unsigned
//   12-13  speed over ground, mm/s, unsigned
//   14-15  instant that all of it holds at, ms modulo 65536 ms of simulation time, unsigned
//   16     the sum of bytes 0 to 15 modulo 256, inverted
//
// The receiver completes the instant: the latest that fits and is not after the reception, so a report may
// be up to 65 s on its way; clocks agree. Rounding: 5 cm, 0.003 degrees, 0.5 mm/s.
//
// The leader's place is carried on along its course at its speed. A follower steers for its place beside
// it: course = leader's course + atan(error across / lookahead), speed = leader's + gain (error along),
// within half the leader's and the greatest speed, so it neither stops nor turns back for a place behind
// it. When the youngest report is older than `fresh_for_s` the leader counts as lost: the follower keeps
// the last course, speed and depth for `keep_course_s`, then circles at the safe depth and speed until a
// report comes. Before the first report it circles likewise. Left out: other followers (they do
// not receive each other; give them places apart), the leader's turning rate.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "clients/autopilot/guidance.h"
#include "clients/autopilot/plan.h"
#include "core/archive.h"
#include "core/frames.h"

namespace halocline::clients {

struct LeaderReport {
  Vec3 position_ned_m = Vec3::Zero();  // each within +-838 km
  double course_rad = 0;
  double speed_mps = 0;  // 0 to 65 m/s
  double time_s = 0;     // simulation time, 0 or above

  void archive(Archive& a) { a(position_ned_m, course_rad, speed_mps, time_s); }
};

inline constexpr std::size_t kReportBytes = 17;

// Throws InvalidArgument for a place or a speed that does not fit.
std::vector<std::uint8_t> encode_report(const LeaderReport& report);

// Empty when it is no such report. `received_s`: simulation time of the reception.
[[nodiscard]] std::optional<LeaderReport> decode_report(std::span<const std::uint8_t> payload,
                                                        double received_s);

enum class FollowPhase { kWaiting, kFollowing, kKeepingCourse, kSafe };

// "follows", "leader lost: keeps its course" ...
std::string to_text(FollowPhase phase);

class Follower {
 public:
  // `safe_radius_m`: of the circle when the leader is lost, above 0.
  Follower(Formation formation, double safe_radius_m)
      : formation_(std::move(formation)), radius_m_(safe_radius_m) {}

  const Formation& formation() const { return formation_; }
  // A report of the past, older than the latest, is ignored.
  void on_report(const LeaderReport& report);

  // Where to steer at `time_s`. The speed is that over ground. Calls come in order of time.
  SetPoints steer_for(double time_s, const Vec3& position_ned_m);
  FollowPhase phase() const { return phase_; }
  void archive(Archive& a) { a(phase_, report_, safe_center_); }

 private:
  FollowPhase phase_at(double time_s) const;
  SetPoints beside_leader(double time_s, const Vec3& position_ned_m) const;

  Formation formation_;
  double radius_m_;
  FollowPhase phase_ = FollowPhase::kWaiting;
  std::optional<LeaderReport> report_;
  std::optional<Vec3> safe_center_;
};

}  // namespace halocline::clients
