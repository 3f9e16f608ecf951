// SPDX-License-Identifier: BSD-3-Clause
// Links that share a search: what that changes, and what it never may.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/modem/modem.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/path_reuse.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/ray_propagation.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/propagation/seabed_profile.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/frames.h"
#include "core/random.h"
#include "core/units.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::tolerance;
using testing::at_s;
using testing::even_water;

constexpr double kCellM = 25;

double draw(std::uint32_t who, std::uint64_t which) {
  return uniform_at({.seed = 9, .purpose = purpose_of("reuse"), .who = who, .which = which});
}

TEST(RayCells, TheLinkThatIsSearchedLiesWithinTwoAndAHalfPercentOfTheRange) {
  for (std::uint32_t i = 0; i < 2000; ++i) {
    const acoustics::RayLink link{200 * draw(i, 0), 200 * draw(i, 1), std::pow(10, 1 + 3 * draw(i, 2))};
    const auto middle = middle_of_cell(link, kCellM);
    ASSERT_TRUE(middle.has_value());
    const double max_m = std::min(0.025 * link.range_m, kCellM / 2) * (1 + 1e-12);
    EXPECT_LE(std::abs(middle->range_m - link.range_m), max_m);
    EXPECT_LE(std::abs(middle->source_depth_m - link.source_depth_m), 0.1 * max_m);
    EXPECT_LE(std::abs(middle->receiver_depth_m - link.receiver_depth_m), 0.1 * max_m);
    EXPECT_GT(middle->source_depth_m, 0);
  }
}

TEST(RayCells, AShortLinkIsSearchedItself) {
  EXPECT_FALSE(middle_of_cell({20, 30, 20.0 / 64 * kCellM - 0.001}, kCellM).has_value());
  EXPECT_TRUE(middle_of_cell({20, 30, 20.0 / 64 * kCellM + 0.001}, kCellM).has_value());
}

// Two vehicles over a slope of a hundredth, known from 1 s on.
class RayReuseTest : public ::testing::Test {
 protected:
  static double slope(double north_m) { return 150 - north_m / 100; }
  RayPropagation rays(const std::shared_ptr<SeabedMap>& bottoms, double reuse_distance_m,
                      bool coherent = false) const {
    RayModel model;
    model.reuse_distance_m = reuse_distance_m;
    model.coherent = coherent;
    return {std::make_shared<EnvironmentTimeline>(acoustics::Environment{}), bottoms, model};
  }
  static Reception in_table(RayPropagation& propagation, const LinkEnd& from, const LinkEnd& to) {
    return propagation.receptions(at_s(1), {{from, to}}, one_after_the_other).front();
  }
  LinkEnd end(VehicleId id, const Vec3& place) const { return {id, place, Vec3::Zero(), &modem_}; }

  const Vec3 first_ = Vec3(0, 0, 31), second_ = Vec3(1000, 0, 62);
  std::shared_ptr<SeabedMap> bottoms_ = testing::seabed_around(first_, second_, slope);
  acoustics::Modem modem_;
};

TEST_F(RayReuseTest, LinksOfOneCellShareASearch) {
  auto propagation = rays(bottoms_, kCellM);
  for (int step = 0; step < 6; ++step) {
    in_table(propagation, end(1, first_), end(2, second_ + Vec3(2.0 * step, 0, 0.05 * step)));
  }
  EXPECT_EQ(propagation.searches(), 1);
}

TEST_F(RayReuseTest, WithoutADistanceEveryLinkIsSearched) {
  auto propagation = rays(bottoms_, 0);
  for (int step = 0; step < 6; ++step) {
    in_table(propagation, end(1, first_), end(2, second_ + Vec3(2.0 * step, 0, 0.05 * step)));
  }
  EXPECT_EQ(propagation.searches(), 6);
}

// Packets and queries depend on no cell.
TEST_F(RayReuseTest, OutsideOfTablesEveryLinkIsSearchedForItself) {
  auto propagation = rays(bottoms_, kCellM), own = rays(bottoms_, 0);
  for (int step = 0; step < 6; ++step) {
    const LinkEnd a = end(1, first_), b = end(2, second_ + Vec3(2.0 * step, 0, 0.05 * step));
    EXPECT_EQ(propagation.reception(at_s(1), a, b).budget.received_level.value,
              own.reception(at_s(1), a, b).budget.received_level.value);
  }
  EXPECT_EQ(propagation.searches(), 6);
}

// Unless packets are to share the searches of tables: then each is the link of a table.
TEST_F(RayReuseTest, PacketsShareTheSearchesOfTablesWhereTheyMay) {
  RayModel model;
  model.reuse_distance_m = kCellM;
  model.reuse_for_packets = true;
  RayPropagation propagation(std::make_shared<EnvironmentTimeline>(acoustics::Environment{}), bottoms_,
                             model);
  for (int step = 0; step < 6; ++step) {
    const LinkEnd a = end(1, first_), b = end(2, second_ + Vec3(2.0 * step, 0, 0.05 * step));
    ASSERT_TRUE(propagation.is_ready_for_packet(at_s(1), a, b));
    const Reception row = in_table(propagation, a, b);
    const Reception packet = propagation.reception_without_capacity(at_s(1), a, b);
    EXPECT_EQ(packet.budget.received_level.value, row.budget.received_level.value);
    ASSERT_EQ(packet.paths.size(), row.paths.size());
    EXPECT_EQ(packet.paths.front().delay_s, row.paths.front().delay_s);
  }
  EXPECT_EQ(propagation.searches(), 1);
}

TEST_F(RayReuseTest, TheLinksOfAPacketTogetherAreAsOneByOne) {
  auto together = rays(bottoms_, kCellM), own = rays(bottoms_, kCellM);
  std::vector<EndPair> links;
  for (int step = 0; step < 6; ++step)
    links.push_back(
        {end(1, first_), end(static_cast<VehicleId>(2 + step), second_ + Vec3(5.0 * step, 0, 0))});
  const auto receptions = together.packet_receptions(at_s(1), links, one_after_the_other);
  ASSERT_EQ(receptions.size(), links.size());
  for (std::size_t i = 0; i < links.size(); ++i) {
    const Reception alone = own.reception_without_capacity(at_s(1), links[i].from, links[i].to);
    ASSERT_TRUE(receptions[i]);
    EXPECT_EQ(receptions[i]->budget.received_level.value, alone.budget.received_level.value);
    EXPECT_EQ(receptions[i]->budget.delay_s, alone.budget.delay_s);
    EXPECT_EQ(receptions[i]->paths.size(), alone.paths.size());
  }
  EXPECT_EQ(together.searches(), 6);
}

// Whatever was computed before, in whatever order, in however many propagations.
TEST_F(RayReuseTest, ResultsDependOnTheQueryAlone) {
  auto forwards = rays(bottoms_, kCellM), backwards = rays(bottoms_, kCellM);
  std::vector<Vec3> places;
  for (std::uint32_t i = 0; i < 12; ++i) {
    places.emplace_back(second_ + Vec3(60 * draw(i, 3), 30 * draw(i, 4), 6 * draw(i, 5)));
  }
  std::vector<Reception> one;
  for (const Vec3& place : places) one.push_back(in_table(forwards, end(1, first_), end(2, place)));
  for (std::size_t i = places.size(); i-- > 0;) {
    auto fresh = rays(bottoms_, kCellM);
    const Reception late = in_table(backwards, end(1, first_), end(2, places[i])),
                    alone = in_table(fresh, end(1, first_), end(2, places[i]));
    ASSERT_EQ(one[i].paths.size(), late.paths.size());
    EXPECT_EQ(one[i].budget.delay_s, late.budget.delay_s);
    EXPECT_EQ(one[i].budget.received_level.value, late.budget.received_level.value);
    EXPECT_EQ(one[i].budget.received_level.value, alone.budget.received_level.value);
    EXPECT_EQ(one[i].budget.delay_s, alone.budget.delay_s);
  }
}

TEST_F(RayReuseTest, BothWaysHaveTheSamePathsToTheLastBit) {
  auto propagation = rays(bottoms_, kCellM);
  const LinkEnd a = end(1, first_), b = end(2, second_ + Vec3(3, 4, 1));
  testing::expect_same_paths(in_table(propagation, a, b), in_table(propagation, b, a));
  EXPECT_EQ(propagation.searches(), 1);
}

// 60 random links at 200 to 1500 m: for nine of ten the first path's delay is within 10 us and the level
// within 0.1 dB of those of a search of their own (a path that begins or ends within a cell makes more).
TEST_F(RayReuseTest, DelayAndLevelAreCloseToThoseOfASearchOfItsOwn) {
  std::vector<double> delays_s, levels_db;
  for (std::uint32_t i = 0; i < 60; ++i) {
    const Vec3 one(0, 0, 20 + 80 * draw(i, 6)), other(200 + 1300 * draw(i, 7), 0, 20 + 80 * draw(i, 8));
    const auto bottoms = testing::seabed_around(one, other, slope);
    auto shared = rays(bottoms, kCellM), own = rays(bottoms, 0);
    const Reception a = in_table(shared, end(1, one), end(2, other)),
                    b = in_table(own, end(1, one), end(2, other));
    ASSERT_FALSE(a.paths.empty() || b.paths.empty());
    delays_s.push_back(std::abs(a.paths.front().delay_s - b.paths.front().delay_s));
    levels_db.push_back(std::abs(a.budget.received_level.value - b.budget.received_level.value));
  }
  std::sort(delays_s.begin(), delays_s.end());
  std::sort(levels_db.begin(), levels_db.end());
  RecordProperty("median_delay_error_ns", static_cast<int>(1e9 * delays_s[30]));
  RecordProperty("tenth_delay_error_ns", static_cast<int>(1e9 * delays_s[54]));
  RecordProperty("median_level_error_mdb", static_cast<int>(1e3 * levels_db[30]));
  RecordProperty("tenth_level_error_mdb", static_cast<int>(1e3 * levels_db[54]));
  EXPECT_LT(delays_s[54], tolerance(10e-6));
  EXPECT_LT(levels_db[54], tolerance(0.1));
}

// A beacon at the depth at which a profile bends: a little above or below it rays have the tube of one layer,
// which makes a tenth of the links differ by more than 0.3 dB.
TEST_F(RayReuseTest, AnEndAtAKnotOfTheWaterKeepsItsDepth) {
  acoustics::Environment sea;
  sea.profile = acoustics::SoundSpeedProfile::from_speeds(
      {{0, 1520}, {20, 1519}, {60, 1494}, {100, 1490}, {200, 1491}}, {10, 35});
  const auto waters = std::make_shared<EnvironmentTimeline>(sea);
  RayModel model;
  RayPropagation own(waters, bottoms_, model);
  model.reuse_distance_m = kCellM;
  RayPropagation shared(waters, bottoms_, model);
  std::vector<double> levels_db;
  for (std::uint64_t i = 0; i < 60; ++i) {
    const LinkEnd beacon = end(1, {0, 0, 60}),
                  other = end(2, {300 + 690 * draw(0, i), 0, 20 + 90 * draw(1, i)});
    const Decibels off = in_table(shared, beacon, other).budget.received_level -
                         in_table(own, beacon, other).budget.received_level;
    levels_db.push_back(std::abs(off.value));
  }
  std::sort(levels_db.begin(), levels_db.end());
  EXPECT_LT(levels_db[54], tolerance(0.1));
}

TEST_F(RayReuseTest, CoherentLevelsAreSearchedForThemselves) {
  auto propagation = rays(bottoms_, kCellM, /*coherent=*/true), own = rays(bottoms_, 0, /*coherent=*/true);
  const LinkEnd a = end(1, first_), b = end(2, second_ + Vec3(3, 4, 1));
  EXPECT_EQ(in_table(propagation, a, b).budget.received_level.value,
            in_table(own, a, b).budget.received_level.value);
}

TEST_F(RayReuseTest, AGivenBottomIsSearchedForItself) {
  auto propagation = rays(bottoms_, kCellM), own = rays(bottoms_, 0);
  const auto seabed = std::make_shared<const SeabedProfile>(SeabedProfile::flat(140));
  const LinkEnd a = end(1, first_), b = end(2, second_ + Vec3(3, 4, 1));
  EXPECT_EQ(propagation.reception_over(at_s(1), a, b, seabed).budget.delay_s,
            own.reception_over(at_s(1), a, b, seabed).budget.delay_s);
}

// The delay follows the receiver within a cell: 1 m further along the way is 1 m / c.
TEST_F(RayReuseTest, DelayFollowsTheReceiverWithinItsCell) {
  auto propagation = rays(bottoms_, kCellM);
  const auto delay_s = [&](double moved_m) {
    return in_table(propagation, end(1, first_), end(2, second_ + Vec3(moved_m, 0, 0))).paths.front().delay_s;
  };
  const double slowness = delay_s(1) - delay_s(0);
  EXPECT_NEAR(1 / slowness, 1500, 40);
  EXPECT_EQ(propagation.searches(), 1);
}

}  // namespace
}  // namespace halocline::channel_server
