// SPDX-License-Identifier: BSD-3-Clause
// Rows that hold on from tick to tick: for how long, what follows the ends meanwhile, and how far it is from
// a row computed again.
#include "channel_server/links/link_row_cache.h"

#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/modem/modem.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/sound_speed.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "channel_server/links/link_predictor.h"
#include "channel_server/links/link_table.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/ray_propagation.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/propagation/straight_propagation.h"
#include "channel_server/vehicles/shard.h"
#include "core/check.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::tolerance;
using testing::at_s;
using testing::even_water;
using testing::for_s;
using testing::quick_modem;

struct Vehicle {
  Vec3 place_ned_m, velocity_ned_mps;
};

// Ticks of a fleet whose vehicles have the ids 1, 2, ...
class Ticks {
 public:
  explicit Ticks(double reuse_distance_m, std::unique_ptr<Propagation> propagation =
                                              std::make_unique<StraightPropagation>(even_water()))
      : kept_(reuse_distance_m), propagation_(std::move(propagation)) {}

  // The rows of all tables, one after the other.
  std::vector<LinkRow> at(double time_s, const std::vector<Vehicle>& fleet) {
    placed_.clear();
    for (const Vehicle& vehicle : fleet) {
      const auto id = static_cast<VehicleId>(placed_.size() + 1);
      placed_.push_back({id, {vehicle.place_ned_m, vehicle.velocity_ned_mps, {}}, &modems_[placed_.size()]});
    }
    rows_ = table_rows(placed_, {}, shard);
    kept_.reuse(at_s(time_s), sea, propagation_->environment(at_s(time_s)), placed_, rows_);
    std::vector<LinkRow> all;
    for (const LinkTable& table :
         link_tables(at_s(time_s), placed_, rows_, *propagation_, predictor_, one_after_the_other, &kept_))
      all.insert(all.end(), table.rows.begin(), table.rows.end());
    return all;
  }
  bool is_reused(std::size_t row) const { return rows_.is_reused(row); }

  LinkRowCache::Sea sea;
  Shard shard;
  std::vector<VehicleModem> modems_{4, quick_modem()};

 private:
  LinkRowCache kept_;
  std::unique_ptr<Propagation> propagation_;
  LinkPredictor predictor_{{}};
  std::vector<PlacedVehicle> placed_;
  TableRows rows_;
};

// The second is 1 km away and moves along the link.
std::vector<Vehicle> two(double moved_m, double speed_mps = 1.5, double depth_m = 50) {
  return {{Vec3(0, 0, 40), Vec3::Zero()}, {Vec3(1000 + moved_m, 0, depth_m), Vec3(speed_mps, 0, 0)}};
}

TEST(LinkRowCache, HoldWhileTheEndsStayWithinTheDistance) {
  Ticks ticks(10);
  ticks.at(0, two(0));
  EXPECT_FALSE(ticks.is_reused(0));
  ticks.at(1, two(9.9));
  EXPECT_TRUE(ticks.is_reused(0));
  EXPECT_TRUE(ticks.is_reused(1));
  ticks.at(2, two(10.1));
  EXPECT_FALSE(ticks.is_reused(0));
  ticks.at(3, two(20));
  EXPECT_TRUE(ticks.is_reused(0)) << "counts from where it was computed last";
}

TEST(LinkRowCache, DepthsCountTenTimes) {
  Ticks ticks(10);
  ticks.at(0, two(0));
  ticks.at(1, two(0, 1.5, 50.9));
  EXPECT_TRUE(ticks.is_reused(0));
  ticks.at(2, two(0, 1.5, 51.1));
  EXPECT_FALSE(ticks.is_reused(0));
}

TEST(LinkRowCache, ShortLinksHoldForAFortiethOfTheirRange) {
  Ticks ticks(100);
  ticks.at(0, two(0));
  ticks.at(1, two(24.9));
  EXPECT_TRUE(ticks.is_reused(0));
  ticks.at(2, two(25.7));
  EXPECT_FALSE(ticks.is_reused(0));
}

TEST(LinkRowCache, AreComputedAnewAfterTenSeconds) {
  Ticks ticks(10);
  ticks.at(0, two(0));
  ticks.at(10, two(0));
  EXPECT_TRUE(ticks.is_reused(0));
  ticks.at(11, two(0));
  EXPECT_FALSE(ticks.is_reused(0));
}

TEST(LinkRowCache, AreComputedAnewWhenSomethingElseChanges) {
  const auto holds_after = [](auto change) {
    Ticks ticks(10);
    ticks.at(0, two(0));
    ticks.at(1, two(0));
    EXPECT_TRUE(ticks.is_reused(0));
    const double speed_mps = change(ticks);
    ticks.at(2, two(0, speed_mps));
    return ticks.is_reused(0);
  };
  EXPECT_TRUE(holds_after([](Ticks&) { return 1.9; }));
  EXPECT_FALSE(holds_after([](Ticks&) { return 2.1; }));
  EXPECT_FALSE(holds_after([](Ticks& ticks) { return ticks.sea.water_id = 1, 1.5; }));
  EXPECT_FALSE(holds_after([](Ticks& ticks) { return ticks.sea.seabed_version = 1, 1.5; }));
  EXPECT_FALSE(holds_after([](Ticks& ticks) { return ticks.modems_[1].modem.source_level.value += 1, 1.5; }));
}

TEST(LinkRowCache, WithoutADistanceNoneHolds) {
  Ticks ticks(0);
  ticks.at(0, two(0));
  ticks.at(1, two(0));
  EXPECT_FALSE(ticks.is_reused(0));
  EXPECT_THROW(LinkRowCache(-1), InvalidArgument);
  EXPECT_THROW(LinkRowCache(1001), InvalidArgument);
}

TEST(LinkRowCache, OfThoseThatLeaveAndJoinTheOthersHold) {
  Ticks ticks(10);
  const std::vector<Vehicle> three{
      {Vec3(0, 0, 40), Vec3::Zero()}, {Vec3(800, 0, 40), Vec3::Zero()}, {Vec3(0, 800, 40), Vec3::Zero()}};
  ticks.at(0, {three[0], three[1]});
  ticks.at(1, three);
  // 1-2, 1-3, 2-1, 2-3, 3-1, 3-2
  EXPECT_TRUE(ticks.is_reused(0));
  EXPECT_FALSE(ticks.is_reused(1));
  EXPECT_TRUE(ticks.is_reused(2));
  EXPECT_FALSE(ticks.is_reused(3));
  ticks.at(2, {three[0], three[1]});
  EXPECT_TRUE(ticks.is_reused(0));
  ticks.at(3, three);
  EXPECT_FALSE(ticks.is_reused(1));
}

// In even water the delay is known: the range over its speed.
TEST(LinkRowCache, DelayAndDopplerFollowTheEnds) {
  Ticks ticks(10);
  const Vec3 velocity(1.2, -0.9, 0.05);
  for (double time_s = 0; time_s <= 5; time_s += 1) {
    const std::vector<Vehicle> fleet{{Vec3(0, 0, 40), Vec3::Zero()},
                                     {Vec3(600, 500, 60) + time_s * velocity, velocity}};
    const LinkRow row = ticks.at(time_s, fleet)[0];
    EXPECT_EQ(ticks.is_reused(0), time_s > 0);
    const Vec3 line = fleet[1].place_ned_m;
    const double range_m = (line - fleet[0].place_ned_m).norm();
    EXPECT_NEAR(row.budget.range_m, range_m, tolerance(1e-9));
    EXPECT_NEAR(row.budget.delay_s, range_m / testing::kSpeedMps, tolerance(1e-7));
    EXPECT_NEAR(row.forecast.first_path_delay_s, range_m / testing::kSpeedMps, tolerance(1e-7));
    const double opening_mps = velocity.dot(line - fleet[0].place_ned_m) / range_m;
    EXPECT_NEAR(row.doppler_factor, 1 - opening_mps / testing::kSpeedMps, tolerance(1e-7));
    EXPECT_EQ(row.paths_age, for_s(time_s));
  }
}

// Deviation of rows from those they replace, root of the mean square.
class Deviation {
 public:
  void add(const std::vector<LinkRow>& rows, const std::vector<LinkRow>& truth) {
    ASSERT_EQ(rows.size(), truth.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      EXPECT_EQ(rows[i].budget.range_m, truth[i].budget.range_m);
      EXPECT_EQ(rows[i].state, truth[i].state);
      EXPECT_NEAR(rows[i].doppler_factor, truth[i].doppler_factor, tolerance(1e-4));
      const double level_db = (rows[i].budget.received_level - truth[i].budget.received_level).value;
      const double delivery = rows[i].forecast.delivery_probability - truth[i].forecast.delivery_probability;
      level_squares_ += level_db * level_db;
      delivery_squares_ += delivery * delivery;
      ++rows_;
    }
  }
  double level_db() const { return std::sqrt(level_squares_ / rows_); }
  double delivery() const { return std::sqrt(delivery_squares_ / rows_); }

 private:
  double level_squares_ = 0, delivery_squares_ = 0;
  int rows_ = 0;
};

// Four vehicles of which one runs, over a slope with ripples, under a thermocline.
class RowsAlongRays : public ::testing::Test {
 protected:
  static constexpr int kSeconds = 40;
  static std::vector<Vehicle> fleet_at(double time_s) {
    const Vec3 velocity(1.2, 0.9, 0);
    return {{Vec3(0, 0, 30), Vec3::Zero()},
            {Vec3(900, 300, 40), Vec3::Zero()},
            {Vec3(400, -700, 60), Vec3::Zero()},
            {Vec3(1300, -200, 20) + time_s * velocity, velocity}};
  }
  static std::unique_ptr<Propagation> rays(double reuse_distance_m) {
    const auto seabed = std::make_shared<SeabedMap>(SeabedRule{});
    testing::survey(*seabed, Vec3(-200, -900, 0), Vec3(1600, 600, 0), [](const Vec3& place) {
      return 120 + place.x() / 50 + 2 * std::sin(place.y() / 40) * std::sin(place.x() / 55);
    });
    for (int i = 0; i <= kSeconds; ++i) {
      for (const Vehicle& from : fleet_at(i)) {
        for (const Vehicle& to : fleet_at(i))
          testing::survey(*seabed, from.place_ned_m, to.place_ned_m, [](const Vec3& place) {
            return 120 + place.x() / 50 + 2 * std::sin(place.y() / 40) * std::sin(place.x() / 55);
          });
      }
    }
    acoustics::Environment water;
    water.profile = acoustics::SoundSpeedProfile::from_water(
        {{0, 22, 38}, {15, 22, 38}, {30, 15, 38}, {50, 13, 38}, {200, 13, 38}},
        acoustics::SoundSpeedModel::kMackenzie1981, 0.7);
    RayModel model;
    model.reuse_distance_m = reuse_distance_m;
    return std::make_unique<RayPropagation>(std::make_shared<EnvironmentTimeline>(water), seabed, model);
  }
};

// Beside rows whose links are searched for themselves at every tick: with cells of 25 m that serve several
// links, and extrapolated over 10 and 25 m as well.
TEST_F(RowsAlongRays, AreHardlyFurtherFromTheExactOnesThanThoseOfSharedSearches) {
  constexpr double kCellM = 25;
  Ticks exact(0, rays(0)), shared(0, rays(kCellM)), near(10, rays(kCellM)), far(25, rays(kCellM));
  Deviation of_shared, of_near, of_far;
  int reused = 0, computed = 0;
  for (int i = 0; i <= kSeconds; ++i) {
    const auto truth = exact.at(i, fleet_at(i));
    of_shared.add(shared.at(i, fleet_at(i)), truth);
    of_near.add(near.at(i, fleet_at(i)), truth);
    of_far.add(far.at(i, fleet_at(i)), truth);
    for (std::size_t k = 0; k < truth.size(); ++k) ++(near.is_reused(k) ? reused : computed);
  }
  EXPECT_GT(reused, 4 * computed);
  EXPECT_LT(of_near.level_db(), of_shared.level_db() + tolerance(0.1));
  EXPECT_LT(of_far.level_db(), of_shared.level_db() + tolerance(0.1));
  EXPECT_LT(of_near.delivery(), of_shared.delivery() + tolerance(0.02));
  EXPECT_LT(of_far.delivery(), of_shared.delivery() + tolerance(0.02));
}

TEST_F(RowsAlongRays, ShardsAgreeWithOneServer) {
  Ticks whole(10, rays(25)), even(10, rays(25)), odd(10, rays(25));
  even.shard = {0, 2};
  odd.shard = {1, 2};
  for (int i = 0; i <= 10; ++i) {
    const auto fleet = fleet_at(i);
    const auto all = whole.at(i, fleet);
    const std::vector<LinkRow> parts[2] = {even.at(i, fleet), odd.at(i, fleet)};
    std::size_t next[2] = {0, 0};
    for (const LinkRow& row : all) {
      const auto shard = static_cast<std::size_t>(row.transmitter_id % 2);
      const LinkRow& part = parts[shard][next[shard]++];
      EXPECT_EQ(row.receiver_id, part.receiver_id);
      EXPECT_EQ(row.budget.delay_s, part.budget.delay_s);
      EXPECT_EQ(row.budget.received_level.value, part.budget.received_level.value);
      EXPECT_EQ(row.paths_age, part.paths_age);
    }
  }
}

}  // namespace
}  // namespace halocline::channel_server
