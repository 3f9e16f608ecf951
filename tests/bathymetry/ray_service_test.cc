// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/ray_service.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/bathymetry/terrain/terrain_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::bathymetry {
namespace {

using halocline::testing::tolerance;

constexpr char kVersion[] = "0123456789abcdef";

// 200 m square around the origin, 100 m deep, with a hole in the far corner.
const Terrain& terrain() {
  static const Terrain made(make_grid(
      {-100, -100, 10, 21, 21}, [](double x, double y) { return x > 95 && y > 95 ? std::nan("") : 100.0; }));
  return made;
}

RayAnswers answers_to(const RayBatch& batch) { return answer(terrain(), kVersion, batch); }

TEST(RayService, AnswersEveryRayInItsOrderWithItsStatus) {
  const RayAnswers answers = answers_to({.rays = {{{0, 0, 40}, {0, 0, 1}, 500},
                                                  {{0, 0, 40}, {0, 0, 1}, 5},
                                                  {{0, 0, 40}, {1, 0, 0}, 500},
                                                  {{80, 80, 40}, {1, 1, 0}, 500},
                                                  {{0, 0, 140}, {0, 0, 1}, 500},
                                                  {{0, 0, 40}, {0, 0, 0}, 500}}});
  using enum RayStatus;
  EXPECT_EQ(answers.refusal, Refusal::kNone);
  EXPECT_EQ(answers.statuses, (std::vector{kHit, kMiss, kOutside, kNoData, kStartedBelowBottom, kBadInput}));
  ASSERT_EQ(answers.results_m.size(), 6u);
  EXPECT_NEAR(answers.results_m[0], 60, tolerance(1e-9));
  for (std::size_t n = 1; n < 6; ++n) EXPECT_EQ(answers.results_m[n], 0) << n;
}

TEST(RayService, OcclusionIsAHitWithinTheRange) {
  const RayAnswers answers = answers_to(
      {.mode = QueryMode::kOccluded, .rays = {{{0, 0, 90}, {0, 3, 4}, 20}, {{0, 0, 90}, {0, 3, 4}, 12}}});
  EXPECT_EQ(answers.statuses, (std::vector{RayStatus::kHit, RayStatus::kMiss}));
}

TEST(RayService, DepthIgnoresDirections) {
  const RayAnswers answers = answers_to({.mode = QueryMode::kDepth,
                                         .rays = {{{3, 4, 0}, {0, 0, 0}, 0},
                                                  {{300, 4, 0}, {0, 0, 0}, 0},
                                                  {{99, 99, 0}, {0, 0, 0}, 0},
                                                  {{std::nan(""), 0, 0}, {0, 0, 0}, 0}}});
  using enum RayStatus;
  EXPECT_EQ(answers.statuses, (std::vector{kHit, kOutside, kNoData, kBadInput}));
  EXPECT_EQ(answers.results_m, (std::vector<double>{100, 0, 0, 0}));
}

// To the last bit: 24 times 0.1 m and 3 times 0.1 m together are not 27 times 0.1 m.
TEST(RayService, ATileHasTheDepthsUnderTheProductsOfItsNumbersAndTheSpacing) {
  const Terrain slope(
      make_grid({-100, -100, 10, 21, 21}, [](double x, double y) { return 100 + 0.3 * x - 0.7 * y; }));
  for (const double spacing_m : {0.1, 0.7, 2.5}) {
    RayBatch points{.mode = QueryMode::kDepth};
    for (int i = 0; i < 64; ++i)
      points.rays.push_back({{(24 + i / 8) * spacing_m, (-16 + i % 8) * spacing_m, 0}, {0, 0, 1}, 1});
    const RayBatch tile{.mode = QueryMode::kDepthTiles,
                        .sample_spacing_m = spacing_m,
                        .rays = {{{24 * spacing_m, -16 * spacing_m, 0}, {0, 0, 1}, 1}}};
    const RayAnswers answers = answer(slope, kVersion, tile), expected = answer(slope, kVersion, points);
    EXPECT_EQ(answers.results_m, expected.results_m) << spacing_m;
    EXPECT_EQ(answers.statuses, std::vector(64, RayStatus::kHit)) << spacing_m;
  }
}

TEST(RayService, EachPointOfATileHasItsStatus) {
  const RayAnswers answers =
      answers_to({.mode = QueryMode::kDepthTiles,
                  .sample_spacing_m = 10,
                  .rays = {{{70, 70, 0}, {0, 0, 1}, 1}, {{std::nan(""), 0, 0}, {0, 0, 1}, 1}}});
  using enum RayStatus;
  ASSERT_EQ(answers.statuses.size(), 128u);
  EXPECT_EQ(answers.statuses[0], kHit);             // 70 m north, 70 m east
  EXPECT_EQ(answers.statuses[3], kHit);             // 100 m east
  EXPECT_EQ(answers.statuses[4], kOutside);         // 110 m east
  EXPECT_EQ(answers.statuses[3 * 8 + 3], kNoData);  // the hole in the corner
  EXPECT_EQ(answers.statuses[4 * 8], kOutside);     // 110 m north
  EXPECT_EQ(answers.results_m[4], answers.results_m[3]) << "for sound the depth of the edge goes on";
  EXPECT_GT(answers.results_m[3 * 8 + 3], 0) << "and that beside the hole";
  EXPECT_EQ(answers.statuses[64], kBadInput);
}

TEST(RayService, TakesSixtyFourTilesAndRefusesOneMore) {
  RayBatch batch{.mode = QueryMode::kDepthTiles,
                 .sample_spacing_m = 1,
                 .rays = std::vector<Ray>(64, {{0, 0, 0}, {0, 0, 1}, 1})};
  EXPECT_EQ(answers_to(batch).statuses.size(), kMaxRays);
  batch.rays.push_back(batch.rays.front());
  EXPECT_EQ(answers_to(batch).refusal, Refusal::kTooMany);
}

TEST(RayService, TakesTheCapAndRefusesOneMore) {
  RayBatch batch{.rays = std::vector<Ray>(kMaxRays, {{0, 0, 40}, {0, 0, 1}, 500})};
  EXPECT_EQ(answers_to(batch).statuses.size(), kMaxRays);
  batch.rays.push_back(batch.rays.front());
  const RayAnswers answers = answers_to(batch);
  EXPECT_EQ(answers.refusal, Refusal::kTooMany);
  EXPECT_TRUE(answers.statuses.empty()) << "refused, not cut";
  EXPECT_NE(answers.reason.find("4097"), std::string::npos);
}

TEST(RayService, RefusesToAnswerForAnotherTerrain) {
  RayBatch batch{.expected_terrain = kVersion, .rays = {{{0, 0, 40}, {0, 0, 1}, 500}}};
  EXPECT_EQ(answers_to(batch).refusal, Refusal::kNone);
  batch.expected_terrain = "fedcba9876543210";
  EXPECT_EQ(answers_to(batch).refusal, Refusal::kOtherTerrain);
}

TEST(RayService, RefusesQueriesThatAreNone) {
  const Ray ray{{0, 0, 40}, {1, 0, 0}, 50};
  EXPECT_EQ(answers_to({.rays = {}}).refusal, Refusal::kBadQuery);
  EXPECT_EQ(answers_to({.mode = static_cast<QueryMode>(4), .rays = {ray}}).refusal, Refusal::kBadQuery);
  EXPECT_EQ(answers_to({.mode = static_cast<QueryMode>(255), .rays = {ray}}).refusal, Refusal::kBadQuery);
  for (const double spacing : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    const RayBatch batch{.mode = QueryMode::kDepthTiles, .sample_spacing_m = spacing, .rays = {ray}};
    EXPECT_EQ(answers_to(batch).refusal, Refusal::kBadQuery) << spacing;
  }
}

}  // namespace
}  // namespace halocline::bathymetry
