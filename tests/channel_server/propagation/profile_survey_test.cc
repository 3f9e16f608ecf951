#include "channel_server/propagation/profile_survey.h"

#include <gtest/gtest.h>

#include "core/check.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::tolerance;

const ProfileRule kRule;  // 10 m, 25 m

// Answers by a seabed that falls by 0.1 m a metre towards the north from 100 m.
ProfileSurvey answered(const Vec3& from, const Vec3& to) {
  ProfileSurvey survey(cells_of(from, to, kRule), kRule);
  std::vector<RayAnswer> answers;
  for (const TerrainRay& ray : survey.rays()) {
    answers.push_back({RayAnswer::Kind::kHit, 100 + 0.1 * ray.origin_ned_m.x()});
  }
  survey.take(answers);
  return survey;
}

TEST(ProfileSurvey, RunsBetweenTheLatticePointsNearestToTheEnds) {
  const ProfileSurvey survey(cells_of({3, -4, 20}, {1007, 996, 80}, kRule), kRule);
  const auto rays = survey.rays();
  EXPECT_EQ(rays.front().origin_ned_m, Vec3(0, 0, 0));
  EXPECT_EQ(rays.back().origin_ned_m, Vec3(1010, 1000, 0));
}

TEST(ProfileSurvey, IsTheSameForAllEndsInTheSameCells) {
  const auto one = answered({-4.9, 0, 20}, {1004.9, 4, 80}), other = answered({4.9, -4, 90}, {995.1, 0, 5});
  EXPECT_EQ(*one.profile(), *other.profile());
  EXPECT_NE(*one.profile(), *answered({5.1, 0, 20}, {1004.9, 4, 80}).profile());
}

TEST(ProfileSurvey, SamplesLieNoFurtherApartThanTheSpacingWithinTheirNumbers) {
  const auto samples = [](double range_m) {
    return ProfileSurvey(cells_of({0, 0, 0}, {range_m, 0, 0}, kRule), kRule).rays().size();
  };
  EXPECT_EQ(samples(0), 16u);
  EXPECT_EQ(samples(100), 16u);
  EXPECT_EQ(samples(1000), 41u);
  EXPECT_EQ(samples(1010), 42u);
  EXPECT_EQ(samples(6370), 256u);
  EXPECT_EQ(samples(50'000), 256u);
}

TEST(ProfileSurvey, OneSampleWithoutAnAnswerLeavesTheBottomUnknown) {
  for (const auto kind : {RayAnswer::Kind::kOutside, RayAnswer::Kind::kNoData, RayAnswer::Kind::kBadInput}) {
    ProfileSurvey survey(cells_of({0, 0, 0}, {200, 0, 0}, kRule), kRule);
    std::vector<RayAnswer> answers(survey.rays().size(), {RayAnswer::Kind::kHit, 50});
    answers[7] = {kind, 0};
    survey.take(answers);
    EXPECT_EQ(survey.profile(), nullptr);
    EXPECT_FALSE(survey.next_query());
  }
}

TEST(ProfileSurvey, TheBottomUnderALinkIsStretchedToItsRange) {
  const auto seabed = answered({0, 0, 0}, {1000, 0, 0}).profile();
  const auto bottom = bottom_under(*seabed, {20, 30, 1004}, 0);
  EXPECT_EQ(bottom.points().front().range_m, 0);
  EXPECT_EQ(bottom.points().back().range_m, 1004);
  EXPECT_NEAR(bottom.depth_at(502), 150, tolerance(1e-9));
}

TEST(ProfileSurvey, DepthsCountFromTheSurface) {
  const SeabedProfile flat(16, 100.0);
  EXPECT_EQ(bottom_under(flat, {20, 30, 500}, -2.5).depth_at(250), 102.5);
}

TEST(ProfileSurvey, UnderAnEndBelowItTheBottomIsLoweredToJustBelowAndNowhereElse) {
  const SeabedProfile flat(16, 100.0);
  const auto bottom = bottom_under(flat, {103, 50, 1500}, 0);
  EXPECT_NEAR(bottom.depth_at(0), 103.1, tolerance(1e-12));
  EXPECT_EQ(bottom.depth_at(100), 100);
  EXPECT_EQ(bottom.depth_at(1500), 100);
}

TEST(ProfileSurvey, LandIsTheLeastOfWater) {
  SeabedProfile island(16, 100.0);
  island[8] = -40;
  const auto bottom = bottom_under(island, {20, 20, 1500}, 0);
  EXPECT_NEAR(bottom.depth_at(800), 0.1, tolerance(1e-12));
}

TEST(ProfileSurvey, OneEndRightAboveTheOtherHasTheBottomBelowBoth) {
  const SeabedProfile flat(16, 100.0);
  EXPECT_EQ(bottom_under(flat, {20, 60, 0}, 0).depth_at(0), 100);
  EXPECT_NEAR(bottom_under(flat, {20, 110, 0}, 0).depth_at(0), 110.1, tolerance(1e-12));
}

TEST(ProfileSurvey, ARidgeCutsTheStraightLineWhenItReachesUpToIt) {
  SeabedProfile ridge(16, 100.0);
  const acoustics::RayLink link{20, 80, 1500};  // the line is 50 m deep in the middle
  ridge[5] = 41;                                // the line is 40 m deep there
  EXPECT_FALSE(cuts_straight_line(bottom_under(ridge, link, 0), link));
  ridge[5] = 39;
  EXPECT_TRUE(cuts_straight_line(bottom_under(ridge, link, 0), link));
}

TEST(ProfileSurvey, ImpossibleRulesAreRefused) {
  EXPECT_THROW(ProfileSurvey({}, {.reuse_distance_m = 0}), InvalidArgument);
  EXPECT_THROW(ProfileSurvey({}, {.spacing_m = 0}), InvalidArgument);
}

}  // namespace
}  // namespace halocline::channel_server
