// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/propagation/seabed_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/check.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::tolerance;
using testing::survey;

// A hill of 30 m over 100 m of water, 300 m wide.
double hill(const Vec3& place) {
  const double north = place.x() - 700, east = place.y() + 40;
  return 100 - 30 * std::exp(-(north * north + east * east) / (2 * 300.0 * 300.0));
}
double slope(const Vec3& place) { return 100 + 0.05 * place.x() - 0.02 * place.y(); }

class SeabedMapTest : public ::testing::Test {
 protected:
  template <class DepthAt>
  SeabedProfile surveyed(const Vec3& from, const Vec3& to, DepthAt seabed) {
    survey(map_, from, to, seabed);
    return *map_.between(from, to);
  }
  static double depth_at(const SeabedProfile& profile, double range_m) {
    return bottom_under(profile, {0, 0, 1}, 0).depth_at(range_m);
  }

  SeabedMap map_{SeabedRule{}};
};

TEST_F(SeabedMapTest, APlaneIsExactUnderEveryLink) {
  const Vec3 from(-310.7, 45.3, 20), to(902.2, 777.7, 50);
  const SeabedProfile profile = surveyed(from, to, slope);
  const double range_m = std::hypot(to.x() - from.x(), to.y() - from.y());
  for (const double share : {0.0, 0.1, 0.37, 0.8, 1.0}) {
    EXPECT_NEAR(depth_at(profile, share * range_m), slope(from + share * (to - from)), tolerance(1e-9));
  }
}

TEST_F(SeabedMapTest, LevelGroundStaysLevelToTheLastBit) {
  const auto profile = surveyed({-310.7, 45.3, 20}, {902.2, 777.7, 50}, [](const Vec3&) { return 123.4; });
  for (const double z_m : profile.z_m) EXPECT_EQ(z_m, 123.4);
}

// Waves of the amplitude a and the length l have (2 pi a / l)^2 / 2, seen along them; a plane has one slope.
TEST_F(SeabedMapTest, SlopesAreThoseAlongTheLink) {
  const auto waves = [](const Vec3& place) {
    return 100 + 0.05 * place.x() + 4 * std::sin(2 * std::numbers::pi * place.x() / 300);
  };
  const Vec3 from(-310.7, 45.3, 20), north(2689.3, 45.3, 20), east(-310.7, 3045.3, 20);
  survey(map_, from, north, waves);
  survey(map_, from, east, waves);
  const double expected = std::pow(2 * std::numbers::pi * 4 / 300, 2) / 2;
  EXPECT_NEAR(map_.places_between(from, north)->mean_square_slope, expected, tolerance(0.1) * expected);
  EXPECT_NEAR(map_.places_between(from, east)->mean_square_slope, 0, 1e-12);
}

TEST_F(SeabedMapTest, SamplesLieASpacingApartAndGoOnBeyondBothEnds) {
  const SeabedProfile profile = surveyed({0, 0, 20}, {1010, 0, 50}, slope);
  EXPECT_EQ(profile.first_m, -37.5);
  EXPECT_EQ(profile.spacing_m, 12.5);
  EXPECT_EQ(profile.z_m.size(), 3u + 82u + 3u);
}

TEST_F(SeabedMapTest, BeyondItsMostSamplesTheyLieFurtherApart) {
  const SeabedProfile profile = surveyed({0, 0, 20}, {12'800, 0, 50}, slope);
  EXPECT_EQ(profile.spacing_m, 25);
  EXPECT_EQ(profile.z_m.size(), 3u + 513u + 3u);
}

// Wherever the ends are, and whichever sample comes or goes: a seabed of at most 6 in 100 changes by no more
// than that times the displacement of each end.
TEST_F(SeabedMapTest, AProfileChangesByNoMoreThanItsEndsMove) {
  const Vec3 to(1495, 310, 50);
  for (double north = 0; north < 120; north += 0.1) {
    const Vec3 from(north, 0.3 * north, 20), moved = from + Vec3(0.1, 0.03, 0);
    const SeabedProfile one = surveyed(from, to, hill), other = surveyed(moved, to, hill);
    for (double range_m = 0; range_m < 1400; range_m += 12.5) {
      ASSERT_NEAR(depth_at(one, range_m), depth_at(other, range_m), 0.06 * 0.11 * 1.1)
          << north << " " << range_m;
    }
  }
}

TEST_F(SeabedMapTest, IsAFunctionOfTheEndsWhateverWasSurveyedBefore) {
  const Vec3 from(10, 20, 30), to(900, -400, 30);
  const SeabedProfile first = surveyed(from, to, hill);
  surveyed({-3000, 0, 0}, {3000, 100, 0}, hill);
  EXPECT_EQ(map_.between(from, to)->z_m, first.z_m);
}

TEST_F(SeabedMapTest, EachTileIsRequestedOnce) {
  const Vec3 from(10, 20, 30), to(900, -400, 30);
  EXPECT_FALSE(map_.is_surveyed(from, to));
  EXPECT_FALSE(map_.is_surveyed(to, from));
  const auto tiles = map_.take_requests();
  EXPECT_GT(tiles.size(), 5u);
  EXPECT_LT(tiles.size(), 30u);
  EXPECT_FALSE(map_.is_surveyed(from, to));
  EXPECT_TRUE(map_.take_requests().empty());
}

TEST_F(SeabedMapTest, WhatIsNotAnsweredIsUnknown) {
  const Vec3 from(10, 20, 30), to(900, -400, 30);
  EXPECT_EQ(map_.between(from, to), nullptr);
}

// The terrain ends between two lattice points: it is known up to its edge.
TEST_F(SeabedMapTest, BeyondTheTerrainTheLastDepthIsHeldAndSaidSo) {
  const auto answer_within = [&](const Vec3& from, const Vec3& to) {
    while (!map_.is_surveyed(from, to)) {
      for (TileSurvey& tile : map_.take_requests()) {
        std::vector<RayAnswer> answers;
        for (const Vec3& point : tile.points_ned_m()) {
          const bool inside = std::abs(point.x()) <= 510 && std::abs(point.y()) <= 490;
          answers.push_back({inside ? RayAnswer::Kind::kHit : RayAnswer::Kind::kOutside, 80});
        }
        tile.take(answers);
        map_.store(tile);
      }
    }
    return map_.between(from, to);
  };
  for (const double north : {-510.0, -501.0, -499.0, 0.0, 509.9, 510.0}) {
    for (const double east : {-490.0, 0.0, 489.0, 490.0}) {
      const auto profile = answer_within({north, east, 10}, {0, 0, 10});
      ASSERT_NE(profile, nullptr) << north << " " << east;
      for (const double z_m : profile->z_m) EXPECT_NEAR(z_m, 80, tolerance(1e-12));
      EXPECT_EQ(profile->beyond_terrain, std::abs(north) >= 500 || std::abs(east) >= 475) << north << east;
    }
  }
  const auto profile = answer_within({700, 0, 10}, {900, 0, 10});
  ASSERT_NE(profile, nullptr);
  EXPECT_TRUE(profile->beyond_terrain);
  EXPECT_TRUE(map_.places_between({0, 0, 10}, {900, 0, 10})->beyond_terrain);
  EXPECT_FALSE(map_.places_between({0, 0, 10}, {400, 0, 10})->beyond_terrain);
}

// Nine places of four tiles at most, where the whole line lies in hundreds of thousands.
TEST_F(SeabedMapTest, PlacesOfALongLineNeedTheTilesAroundThemAlone) {
  const Vec3 from(0, 0, 10), to(1e6, 3e5, 10);
  std::vector<double> z_m(9);
  EXPECT_FALSE(map_.are_places_surveyed(from, to, 9));
  EXPECT_FALSE(map_.read_between(from, to, z_m));
  std::vector<TileSurvey> requests = map_.take_requests();
  EXPECT_LE(requests.size(), 36u);
  for (TileSurvey& tile : requests) {
    tile.take(std::vector<RayAnswer>(64, {RayAnswer::Kind::kHit, 70}));
    map_.store(tile);
  }
  EXPECT_TRUE(map_.are_places_surveyed(from, to, 9));
  EXPECT_TRUE(map_.read_between(from, to, z_m));
  EXPECT_EQ(z_m, std::vector<double>(9, 70));
}

TEST_F(SeabedMapTest, ATileThatFailedIsUnknownUntilFailuresAreForgotten) {
  const Vec3 from(10, 20, 30), to(90, 40, 30);
  EXPECT_FALSE(map_.is_surveyed(from, to));
  for (const TileSurvey& tile : map_.take_requests()) map_.note_failed(tile);
  EXPECT_TRUE(map_.is_surveyed(from, to));
  EXPECT_EQ(map_.between(from, to), nullptr);
  map_.forget_failures();
  EXPECT_FALSE(map_.is_surveyed(from, to));
  survey(map_, from, to, slope);
  EXPECT_NE(map_.between(from, to), nullptr);
}

TEST_F(SeabedMapTest, AnotherTerrainIsSurveyedAnewUnderAnotherVersion) {
  const Vec3 from(10, 20, 30), to(90, 40, 30);
  survey(map_, from, to, slope);
  const auto version = map_.version();
  map_.clear();
  EXPECT_NE(map_.version(), version);
  EXPECT_FALSE(map_.is_surveyed(from, to));
}

TEST(SeabedMap, ImpossibleRulesAreRefused) {
  EXPECT_THROW(SeabedMap({.spacing_m = 0.5}), InvalidArgument);
  EXPECT_THROW(SeabedMap({.spacing_m = 1001}), InvalidArgument);
}

}  // namespace
}  // namespace halocline::channel_server
