// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/links/echo_survey.h"

#include <gtest/gtest.h>

#include "acoustics/link/link_kernel.h"
#include "channel_server/propagation/straight_propagation.h"
#include "core/check.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::tolerance;
using Kind = RayAnswer::Kind;

const Vec3 kFrom(0, 0, 40), kTo(900, 0, 70);

std::vector<RayAnswer> same_answer(std::size_t count, RayAnswer answer) { return {count, answer}; }

// A survey over a flat bottom, with every way free unless given otherwise.
EchoSurvey surveyed(double bottom_z_m, RayAnswer ways = {Kind::kMiss, 0}) {
  EchoSurvey survey(kFrom, kTo, 3);
  survey.take_depths(same_answer(3, {Kind::kHit, bottom_z_m}));
  survey.take_ways(same_answer(6, ways));
  return survey;
}

acoustics::Modem modem_with_cutoff(double cutoff_db) {
  acoustics::Modem modem;
  modem.source_level = {150};
  modem.min_receivable_level = {cutoff_db};
  return modem;
}

TEST(EchoSurvey, QueriesTheBottomUnderTheMiddlesOfEqualParts) {
  const auto rays = EchoSurvey(kFrom, kTo, 3).depth_rays();
  ASSERT_EQ(rays.size(), 3u);
  EXPECT_NEAR(rays[0].origin_ned_m.x(), 150, tolerance(1e-9));
  EXPECT_NEAR(rays[1].origin_ned_m.x(), 450, tolerance(1e-9));
  EXPECT_NEAR(rays[2].origin_ned_m.x(), 750, tolerance(1e-9));
  EXPECT_EQ(rays[1].direction, Vec3(0, 0, 1));
}

TEST(EchoSurvey, QueriesBothWaysFromTheEndsDownAndStopsShortOfTheBottom) {
  EchoSurvey survey(kFrom, kTo, 3);
  survey.take_depths(same_answer(3, {Kind::kHit, 200}));
  const auto rays = survey.way_rays();
  ASSERT_EQ(rays.size(), 6u);
  EXPECT_EQ(rays[0].origin_ned_m, kFrom);
  EXPECT_EQ(rays[1].origin_ned_m, kTo);
  const Vec3 first_point(150, 0, 200);
  EXPECT_LT((rays[0].direction - (first_point - kFrom)).norm(), tolerance(1e-9));
  EXPECT_NEAR(rays[0].max_range_m, (first_point - kFrom).norm() - EchoSurvey::kShortOfBottomM,
              tolerance(1e-9));
}

TEST(EchoSurvey, AnEndOnTheBottomQueriesNoImpossibleRay) {
  EchoSurvey survey({0, 0, 100}, {0, 0, 50}, 1);
  survey.take_depths(same_answer(1, {Kind::kHit, 100}));
  for (const TerrainRay& ray : survey.way_rays()) {
    EXPECT_GT(ray.direction.norm(), 0);
    EXPECT_GT(ray.max_range_m, 0);
  }
}

TEST(EchoSurvey, UnknownDepthsAreLeftOutAndMakeItIncomplete) {
  EchoSurvey survey(kFrom, kTo, 3);
  survey.take_depths(std::vector<RayAnswer>{{Kind::kHit, 200}, {Kind::kOutside, 0}, {Kind::kNoData, 0}});
  EXPECT_EQ(survey.bottom().size(), 1u);
  EXPECT_EQ(survey.way_rays().size(), 2u);
  EXPECT_FALSE(survey.complete());
}

TEST(EchoSurvey, AnAnswerOfAnotherCountIsRefused) {
  EchoSurvey survey(kFrom, kTo, 3);
  EXPECT_THROW(survey.take_depths(same_answer(2, {})), InvalidArgument);
}

TEST(EchoSurvey, AWayWithoutAnAnswerMakesItIncomplete) {
  EXPECT_TRUE(surveyed(200).complete());
  EXPECT_FALSE(surveyed(200, {Kind::kOutside, 0}).complete());
  EXPECT_FALSE(surveyed(200, {Kind::kBadInput, 0}).complete());
  EXPECT_TRUE(surveyed(200, {Kind::kHit, 5}).complete());
}

class MultipathOfTest : public ::testing::Test {
 protected:
  Multipath verdict_of(const EchoSurvey& survey, double cutoff_db, bool reversed = false) {
    const auto modem = modem_with_cutoff(cutoff_db);
    return multipath_of(survey, reversed, SimTime(), propagation_, modem, modem);
  }
  StraightPropagation propagation_{testing::even_water()};
};

TEST_F(MultipathOfTest, IsLikelyWhenAFreeEchoIsLoudEnough) {
  EXPECT_EQ(verdict_of(surveyed(200), 60), Multipath::kLikely);
  EXPECT_EQ(verdict_of(surveyed(200), 149), Multipath::kUnlikely);
}

TEST_F(MultipathOfTest, IsUnlikelyWhenTerrainStandsInEveryWay) {
  EXPECT_EQ(verdict_of(surveyed(200, {Kind::kHit, 5}), 60), Multipath::kUnlikely);
  EXPECT_EQ(verdict_of(surveyed(200, {Kind::kBelowBottom, 0}), 60), Multipath::kUnlikely);
}

TEST_F(MultipathOfTest, IsUnknownWhenNoEchoIsFoundAndAnswersAreMissing) {
  EchoSurvey survey(kFrom, kTo, 3);
  survey.take_depths(same_answer(3, {Kind::kNoData, 0}));
  EXPECT_EQ(verdict_of(survey, 60), Multipath::kUnknown);
}

TEST_F(MultipathOfTest, IsLikelyByOneKnownEchoAlthoughAnswersAreMissing) {
  EchoSurvey survey(kFrom, kTo, 3);
  survey.take_depths(std::vector<RayAnswer>{{Kind::kHit, 200}, {Kind::kNoData, 0}, {Kind::kNoData, 0}});
  survey.take_ways(same_answer(2, {Kind::kMiss, 0}));
  EXPECT_EQ(verdict_of(survey, 60), Multipath::kLikely);
}

TEST_F(MultipathOfTest, ServesBothDirections) {
  for (const double cutoff_db : {60.0, 100.0, 105.0, 110.0}) {
    EXPECT_EQ(verdict_of(surveyed(200), cutoff_db), verdict_of(surveyed(200), cutoff_db, /*reversed=*/true));
  }
}

// Boundary of the likelihood by hand: over a bottom 130 m below both ends and a link of 900 m the shortest
// echo runs 2 hypot(450, 130) m.
TEST_F(MultipathOfTest, ChangesAtTheLevelOfTheShortestEcho) {
  EchoSurvey survey({0, 0, 70}, {900, 0, 70}, 3);
  survey.take_depths(same_answer(3, {Kind::kHit, 200}));
  survey.take_ways(same_answer(6, {Kind::kMiss, 0}));
  const double level_db =
      acoustics::echo_path(
          acoustics::LinkKernel(testing::even_water(), modem_with_cutoff(0), modem_with_cutoff(0)),
          {0, 0, 70}, {900, 0, 70}, {{450, 0, 200}})
          .level.value;
  EXPECT_EQ(verdict_of(survey, level_db - 0.001), Multipath::kLikely);
  EXPECT_EQ(verdict_of(survey, level_db + 0.001), Multipath::kUnlikely);
}

}  // namespace
}  // namespace halocline::channel_server
