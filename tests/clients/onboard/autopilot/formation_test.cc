// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/autopilot/formation.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/check.h"
#include "tests/support/tolerance.h"

namespace halocline::clients {
namespace {

using ::halocline::testing::tolerance;

using std::numbers::pi;
const double kFormationRounding = tolerance(1e-9);

const LeaderReport kReport{{-1234.56, 78.94, 105.31}, -2.5, 1.6, 100.25};

TEST(LeaderReport, SurvivesItsWayToWithinTheRounding) {
  const auto report = decode_report(encode_report(kReport), 103);
  ASSERT_TRUE(report);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(report->position_ned_m[i], kReport.position_ned_m[i], 0.0501);
  EXPECT_NEAR(report->course_rad, kReport.course_rad, pi / 65536 * 1.001);
  EXPECT_NEAR(report->speed_mps, kReport.speed_mps, 0.0005001);
  EXPECT_NEAR(report->time_s, kReport.time_s, 0.0005001);
}

TEST(LeaderReport, HasTheLayoutThatIsWrittenDown) {
  const std::vector<std::uint8_t> expected{0xF1, 0x01, 0x00, 0x00, 0xFF, 0xFF, 0xFF, 0xD0, 0x07,
                                           0x00, 0x00, 0x40, 0xDC, 0x05, 0xE8, 0x03, 0x2D};
  // 1 dm north, 1 dm west, 200 m down, east, 1.5 m/s, second 1. Sum: 241 + 1 + 765 + 215 + 64 + 225 + 235 =
  // 0x6D2; 0xFF - 0xD2 = 0x2D.
  EXPECT_EQ(encode_report({{0.1, -0.1, 200}, pi / 2, 1.5, 1}), expected);
}

TEST(LeaderReport, InstantIsCompletedAcrossTheWrapOfItsCount) {
  LeaderReport report = kReport;
  report.time_s = 65.5;  // 36 ms before the count wraps
  EXPECT_NEAR(decode_report(encode_report(report), 66.2)->time_s, 65.5, kFormationRounding);
  report.time_s = 5000.123;
  EXPECT_NEAR(decode_report(encode_report(report), 5060)->time_s, 5000.123, kFormationRounding);
}

TEST(LeaderReport, DamagedBytesAreNoReport) {
  const auto sound = encode_report(kReport);
  for (std::size_t i = 0; i < sound.size(); ++i) {
    auto damaged = sound;
    damaged[i] ^= 0x10;
    EXPECT_FALSE(decode_report(damaged, 103)) << i;
  }
  EXPECT_FALSE(decode_report(std::span(sound).first(16), 103));
  EXPECT_FALSE(decode_report({}, 103));
}

TEST(LeaderReport, PlaceTooFarAwayIsRefused) {
  EXPECT_THROW(encode_report({{9e5, 0, 0}, 0, 1, 0}), InvalidArgument);
  EXPECT_THROW(encode_report({{0, 0, 0}, 0, 70, 0}), InvalidArgument);
}

// A leader at the origin of second 100, 50 m deep, that goes east at 1.5 m/s; a place 30 m astern, 20 m to
// starboard.
Follower follower() {
  Formation formation;
  formation.along_m = -30;
  formation.across_m = 20;
  formation.below_m = 5;
  Follower follower(formation, 40);
  follower.on_report({{0, 0, 50}, pi / 2, 1.5, 100});
  return follower;
}

TEST(Follower, InItsPlaceItGoesAsTheLeaderDoes) {
  Follower f = follower();
  // Ten seconds later: 15 m on, less 30 m; starboard of east is south.
  const SetPoints points = f.steer_for(110, {-20, -15, 55});
  EXPECT_NEAR(points.course_rad, pi / 2, kFormationRounding);
  EXPECT_NEAR(points.speed_mps, 1.5, kFormationRounding);
  EXPECT_EQ(points.z_ned_m, 55);
  EXPECT_EQ(f.phase(), FollowPhase::kFollowing);
}

TEST(Follower, BehindItsPlaceItGoesFasterAndAheadOfItSlower) {
  Follower f = follower();
  EXPECT_GT(f.steer_for(110, {-20, -20, 55}).speed_mps, 1.5);
  EXPECT_LT(f.steer_for(110, {-20, -10, 55}).speed_mps, 1.5);
}

TEST(Follower, NeitherRacesNorTurnsBackForAPlaceFarAway) {
  Follower f = follower();
  EXPECT_EQ(f.steer_for(110, {-20, -1e4, 55}).speed_mps, Formation{}.max_speed_mps);
  EXPECT_EQ(f.steer_for(110, {-20, 1e4, 55}).speed_mps, 0.75);
  EXPECT_LT(std::abs(wrapped(f.steer_for(110, {1e4, 0, 55}).course_rad - pi / 2)), pi / 2);
}

TEST(Follower, BesideItsPlaceItTurnsTowardsIt) {
  Follower f = follower();
  EXPECT_GT(f.steer_for(110, {-10, -15, 55}).course_rad, pi / 2);  // it lies further south
}

TEST(Follower, KeepsTheLastCourseThenCirclesAtItsSafeDepth) {
  Follower f = follower();
  const Formation formation;
  const double lost_s = 100 + formation.fresh_for_s, safe_s = lost_s + formation.keep_course_s;
  SetPoints points = f.steer_for(lost_s + 0.1, {500, 500, 55});
  EXPECT_EQ(f.phase(), FollowPhase::kKeepingCourse);
  EXPECT_NEAR(points.course_rad, pi / 2, kFormationRounding);
  EXPECT_EQ(points.speed_mps, 1.5);
  EXPECT_EQ(points.z_ned_m, 55);
  points = f.steer_for(safe_s + 0.1, {500, 500, 55});
  EXPECT_EQ(f.phase(), FollowPhase::kSafe);
  EXPECT_EQ(points.z_ned_m, formation.safe_depth_m);
  EXPECT_EQ(points.speed_mps, formation.safe_speed_mps);
  // The circle lies about where it began: from there on it, north of the centre, the course is east.
  EXPECT_NEAR(f.steer_for(safe_s + 1, {540, 500, 55}).course_rad, pi / 2, kFormationRounding);
}

TEST(Follower, ResumesWhenAReportComes) {
  Follower f = follower();
  f.steer_for(1000, {0, 0, 55});
  f.on_report({{0, 1000, 50}, 0, 1.5, 1001});
  f.steer_for(1002, {0, 0, 55});
  EXPECT_EQ(f.phase(), FollowPhase::kFollowing);
}

TEST(Follower, ReportOvertakenOnItsWayIsIgnored) {
  Follower f = follower();
  f.on_report({{500, 500, 20}, 0, 1, 99});
  EXPECT_EQ(f.steer_for(110, {-20, -15, 55}).z_ned_m, 55);
}

TEST(Follower, BeforeTheFirstReportItCircles) {
  Follower f(Formation{}, 40);
  EXPECT_EQ(f.steer_for(0, {0, 0, 20}).z_ned_m, Formation{}.safe_depth_m);
  EXPECT_EQ(f.phase(), FollowPhase::kWaiting);
}

}  // namespace
}  // namespace halocline::clients
