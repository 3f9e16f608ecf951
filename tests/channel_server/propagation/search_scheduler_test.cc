// SPDX-License-Identifier: BSD-3-Clause
// A budget of searches a tick: who is searched first, what the others get, and that shards agree.
#include "channel_server/propagation/search_scheduler.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/modem/modem.h"
#include "acoustics/sea/environment.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/ray_propagation.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/for_each.h"
#include "core/frames.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::tolerance;
using testing::at_s;

SearchScheduler::Wanted wanted(VehicleId low, double range_m, double excess_db) {
  SearchScheduler::Wanted one{.id = {low, 100, 25'000}, .query = {}, .excess_db = excess_db};
  one.query.link = {30, 40, range_m};
  one.query.places = {0, 0, range_m, 0};
  return one;
}

TEST(SearchScheduler, TheMostAudibleNewLinksComeFirst) {
  SearchScheduler budget(2);
  budget.begin_tick(at_s(1), {wanted(1, 500, 10), wanted(2, 500, 30), wanted(3, 500, 20)});
  EXPECT_EQ(budget.find({1, 100, 25'000}), nullptr);
  EXPECT_NE(budget.find({2, 100, 25'000}), nullptr);
  EXPECT_NE(budget.find({3, 100, 25'000}), nullptr);
}

TEST(SearchScheduler, OfLinksAsAudibleTheMostChangedComesFirst) {
  SearchScheduler one(1);
  one.begin_tick(at_s(1), {wanted(1, 500, 10)});
  one.begin_tick(at_s(2), {wanted(1, 500, 10), wanted(2, 500, 10)});
  one.begin_tick(at_s(3), {wanted(1, 525, 10), wanted(2, 550, 10)});
  EXPECT_EQ(one.find({1, 100, 25'000})->query.link.range_m, 500);
  EXPECT_EQ(one.find({1, 100, 25'000})->current_at, at_s(2));
  EXPECT_EQ(one.find({2, 100, 25'000})->query.link.range_m, 550);
}

// 6 dB weaker, but moved by four times as much.
TEST(SearchScheduler, WeighsAudibilityAgainstChange) {
  SearchScheduler tight(1);
  tight.begin_tick(at_s(1), {wanted(1, 500, 16)});
  tight.begin_tick(at_s(2), {wanted(1, 500, 16), wanted(2, 500, 10)});
  tight.begin_tick(at_s(3), {wanted(1, 525, 16), wanted(2, 600, 10)});
  EXPECT_EQ(tight.find({2, 100, 25'000})->query.link.range_m, 600);
  tight.begin_tick(at_s(4), {wanted(1, 525, 16), wanted(2, 610, 10)});
  EXPECT_EQ(tight.find({1, 100, 25'000})->query.link.range_m, 525);
}

TEST(SearchScheduler, AnyOrderOfLinksSchedulesTheSame) {
  std::vector<SearchScheduler::Wanted> links;
  for (VehicleId id = 1; id <= 9; ++id) links.push_back(wanted(id, 500, id % 3));
  SearchScheduler forwards(4), backwards(4);
  forwards.begin_tick(at_s(1), links);
  std::reverse(links.begin(), links.end());
  backwards.begin_tick(at_s(1), links);
  for (VehicleId id = 1; id <= 9; ++id)
    EXPECT_EQ(forwards.find({id, 100, 25'000}) == nullptr, backwards.find({id, 100, 25'000}) == nullptr)
        << id;
}

TEST(SearchScheduler, AnotherRunBeginsAnew) {
  SearchScheduler budget(1);
  budget.begin_tick(at_s(5), {wanted(1, 500, 10)});
  budget.begin_tick(at_s(1), {wanted(1, 500, 10), wanted(2, 500, 20)});
  EXPECT_EQ(budget.find({1, 100, 25'000}), nullptr);
  EXPECT_NE(budget.find({2, 100, 25'000}), nullptr);
}

// Four vehicles of which the last moves away at 5 m/s, over a slope.
class ScheduledRaysTest : public ::testing::Test {
 protected:
  RayPropagation rays(int searches) const {
    RayModel model;
    model.reuse_distance_m = 25;
    model.reuse_for_packets = true;
    model.max_searches_per_tick = searches;
    return {waters_, bottoms_, model};
  }
  std::vector<EndPair> links_at(double time_s) const {
    const std::vector<LinkEnd> ends{{1, Vec3(0, 0, 30), Vec3::Zero(), &modem_},
                                    {2, Vec3(700, 100, 40), Vec3::Zero(), &modem_},
                                    {3, Vec3(300, 400, 60), Vec3::Zero(), &modem_},
                                    {4, Vec3(600 + 5 * time_s, 300, 50), Vec3(5, 0, 0), &modem_}};
    std::vector<EndPair> links;
    for (const LinkEnd& from : ends) {
      for (const LinkEnd& to : ends) {
        if (from.id != to.id) links.push_back({from, to});
      }
    }
    return links;
  }
  static std::vector<Reception> tick(RayPropagation& propagation, double time_s,
                                     const std::vector<EndPair>& all, const std::vector<EndPair>& own) {
    propagation.begin_tick(at_s(time_s), all);
    return propagation.receptions(at_s(time_s), own, one_after_the_other);
  }

  ScheduledRaysTest() {
    for (int time_s = 0; time_s <= 40; ++time_s) {
      for (const auto& [from, to] : links_at(time_s))
        testing::survey(*bottoms_, from.position_ned_m, to.position_ned_m,
                        [](const Vec3& place) { return 150 - place.x() / 100; });
    }
  }

  acoustics::Modem modem_;
  std::shared_ptr<EnvironmentTimeline> waters_ =
      std::make_shared<EnvironmentTimeline>(acoustics::Environment{});
  std::shared_ptr<SeabedMap> bottoms_ = std::make_shared<SeabedMap>(SeabedRule{});
};

TEST_F(ScheduledRaysTest, NoTickSearchesMoreThanTheLimit) {
  RayPropagation propagation = rays(2);
  std::int64_t before = 0;
  for (int i = 1; i <= 30; ++i) {
    tick(propagation, i, links_at(i), links_at(i));
    EXPECT_LE(propagation.searches() - before, 2) << i;
    before = propagation.searches();
  }
  EXPECT_GT(before, 6);
}

TEST_F(ScheduledRaysTest, ALinkIsStraightUntilItsTurnAndTellsTheAgeOfItsPathsAfterIt) {
  RayPropagation propagation = rays(1);
  bool aged = false;
  for (int i = 1; i <= 40; ++i) {
    const auto receptions = tick(propagation, i, links_at(i), links_at(i));
    const auto waiting = std::count_if(receptions.begin(), receptions.end(), [](const Reception& one) {
      return one.used == PropagationUsed::kStraightNotSearched;
    });
    EXPECT_EQ(waiting, 2 * std::max(6 - i, 0)) << i;
    for (const Reception& one : receptions) aged = aged || one.paths_age.seconds() > 0;
  }
  EXPECT_TRUE(aged);
}

// Extrapolated from where they were a little before.
TEST_F(ScheduledRaysTest, AgedPathsAreCloseToThoseOfAFullSearch) {
  RayPropagation few = rays(1), all = rays(0);
  for (int i = 1; i <= 20; ++i) {
    const auto receptions = tick(few, i, links_at(i), links_at(i));
    if (i < 7) continue;
    const auto exact = all.receptions(at_s(i), links_at(i), one_after_the_other);
    for (std::size_t k = 0; k < exact.size(); ++k) {
      EXPECT_NEAR(receptions[k].budget.delay_s, exact[k].budget.delay_s, tolerance(1e-3)) << i << ' ' << k;
    }
  }
}

TEST_F(ScheduledRaysTest, ShardsAgreeWithOneServer) {
  RayPropagation one = rays(2), even = rays(2), odd = rays(2);
  for (int i = 1; i <= 30; ++i) {
    const auto all = links_at(i);
    std::vector<EndPair> own[2];
    for (const EndPair& link : all) own[link.from.id % 2].push_back(link);
    const auto whole = tick(one, i, all, all);
    const std::vector<Reception> parts[2] = {tick(even, i, all, own[0]), tick(odd, i, all, own[1])};
    std::size_t next[2] = {0, 0};
    for (std::size_t k = 0; k < all.size(); ++k) {
      const auto shard = static_cast<std::size_t>(all[k].from.id % 2);
      const Reception& part = parts[shard][next[shard]++];
      EXPECT_EQ(whole[k].used, part.used);
      EXPECT_EQ(whole[k].paths_age, part.paths_age);
      EXPECT_EQ(whole[k].budget.received_level.value, part.budget.received_level.value);
      EXPECT_EQ(whole[k].budget.delay_s, part.budget.delay_s);
    }
  }
}

TEST_F(ScheduledRaysTest, ALimitForAllChangesNothing) {
  RayPropagation ample = rays(100), unbounded = rays(0);
  for (int i = 1; i <= 10; ++i) {
    const auto a = tick(ample, i, links_at(i), links_at(i)), b = tick(unbounded, i, links_at(i), links_at(i));
    for (std::size_t k = 0; k < a.size(); ++k) {
      EXPECT_EQ(a[k].budget.received_level.value, b[k].budget.received_level.value);
      EXPECT_EQ(a[k].paths_age.seconds(), 0);
    }
  }
}

// A server whose link was scheduled before the change, and one whose never was.
TEST_F(ScheduledRaysTest, APacketIsSearchedInTheWaterThatItIsSentInto) {
  const auto links = links_at(6);
  RayPropagation scheduled = rays(100), fresh = rays(100);
  tick(scheduled, 6, links, links);
  const std::int64_t before = scheduled.searches();
  scheduled.reception_without_capacity(at_s(6.1), links[0].from, links[0].to);
  EXPECT_EQ(scheduled.searches(), before);

  EnvironmentChange warmer;
  warmer.profile = acoustics::SoundSpeedProfile::isovelocity(1540, {});
  ASSERT_EQ(waters_->announce(at_s(6.2), at_s(6.2), {1, 1}, warmer), "");
  for (const auto& [from, to] : links) {
    const Reception a = scheduled.reception_without_capacity(at_s(6.3), from, to),
                    b = fresh.reception_without_capacity(at_s(6.3), from, to);
    EXPECT_EQ(a.used, PropagationUsed::kRays);
    EXPECT_EQ(a.budget.delay_s, b.budget.delay_s);
    EXPECT_EQ(a.budget.received_level.value, b.budget.received_level.value);
  }
}

}  // namespace
}  // namespace halocline::channel_server
