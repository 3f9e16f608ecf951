// SPDX-License-Identifier: BSD-3-Clause
// Formation keeping: a follower holds a place relative to a leader by the leader's acoustic reports, with a
// fallback when they stop.
//
// A report is 17 bytes, little-endian, small enough for the slowest modem:
//
//   byte   field                              unit               type
//   0      kind, 0xF1
//   1-3    north                              decimetre          signed
//   4-6    east                               decimetre          signed
//   7-9    z                                  decimetre          signed
//   10-11  course over ground                 turn / 65536       unsigned
//   12-13  speed over ground                  mm/s               unsigned
//   14-15  instant of validity, modulo        ms of simulation   unsigned
//          65536 ms                           time
//   16     inverted sum of bytes 0 to 15,
//          modulo 256
//
// The receiver completes the instant to the latest one that fits and is not after the reception, so a report
// may take up to 65 s from its making to its reception; the clocks are taken to agree. Rounding: 5 cm, 0.003
// degrees, 0.5 mm/s.
//
// The leader's position is extrapolated along its course at its speed. The follower steers for its place
// relative to the leader by
//
//   course = course_leader + atan(e_across / lookahead)
//   speed  = speed_leader + gain e_along,  limited to half the leader's speed ... max_speed_mps
//
// so that it neither stops nor turns back for a place behind it. When the youngest report is older than
// `fresh_for_s`, the leader counts as lost: the follower keeps the last course, speed and depth for
// `keep_course_s`, then circles at the safe depth and speed until a report arrives. Before the first report
// it circles likewise. Left out: other followers (they do not receive each other, so give them places that
// are apart) and the leader's turning rate.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "clients/onboard/autopilot/guidance.h"
#include "clients/onboard/autopilot/plan.h"
#include "core/archive.h"
#include "core/frames.h"

namespace halocline::clients {

struct LeaderReport {
  Vec3 position_ned_m = Vec3::Zero();  // each component within +-838 km
  double course_rad = 0;
  double speed_mps = 0;  // 0 to 65 m/s
  double time_s = 0;     // s, simulation time at which position, course and speed hold, 0 or above

  void archive(Archive& a) { a(position_ned_m, course_rad, speed_mps, time_s); }
};

inline constexpr std::size_t kReportBytes = 17;

// Throws InvalidArgument when a position or a speed is out of the range of the format.
std::vector<std::uint8_t> encode_report(const LeaderReport& report);

// Returns the report; empty when `payload` is not a valid one. `received_s`: simulation time of the
// reception.
[[nodiscard]] std::optional<LeaderReport> decode_report(std::span<const std::uint8_t> payload,
                                                        double received_s);

enum class FollowPhase { kWaiting, kFollowing, kKeepingCourse, kSafe };

// Returns the phase in words, as "follows its leader".
std::string to_text(FollowPhase phase);

class Follower {
 public:
  // `safe_radius_m`: radius of the circle flown without a leader, above 0.
  Follower(Formation formation, double safe_radius_m)
      : formation_(std::move(formation)), radius_m_(safe_radius_m) {}

  const Formation& formation() const { return formation_; }
  // Adds a report; one that is not newer than the latest is ignored.
  void on_report(const LeaderReport& report);

  // Returns the set points at `time_s`; their speed is over ground. Calls must come in order of time.
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
