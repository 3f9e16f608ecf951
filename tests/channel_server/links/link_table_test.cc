// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/links/link_table.h"

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/link/bottom_echo.h"
#include "acoustics/link/link_budget.h"
#include "acoustics/link/link_kernel.h"
#include "acoustics/modem/modem.h"
#include "channel_server/links/receiver_noise.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/straight_propagation.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/sim_time.h"
#include "core/units.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::tolerance;
using testing::at_s;
using testing::even_water;
using testing::for_s;
using testing::kSpeedMps;
using testing::quick_modem;
using testing::state_at;

class LinkTableTest : public ::testing::Test {
 protected:
  std::vector<LinkTable> tables_at(double time_s) {
    const auto placed = place_all(fleet_, at_s(time_s));
    return link_tables(at_s(time_s), placed, table_rows(placed), propagation_, predictor_);
  }
  VehicleRegistry fleet_{{for_s(0.05), for_s(5)}, {quick_modem(), {}}};
  StraightPropagation propagation_{even_water()};
  LinkPredictor predictor_{{}};
};

TEST_F(LinkTableTest, HoldsARowForEveryOtherVehicleById) {
  for (const VehicleId id : {9, 2, 5})
    EXPECT_EQ(fleet_.add_state(testing::name_of(id), id, state_at(0, {1.0 * id, 0, 50})), "");
  const auto tables = tables_at(1);
  ASSERT_EQ(tables.size(), 3u);
  EXPECT_EQ(tables[1].vehicle_id, 5);
  ASSERT_EQ(tables[1].rows.size(), 2u);
  EXPECT_EQ(tables[1].rows[0].receiver_id, 2);
  EXPECT_EQ(tables[1].rows[1].receiver_id, 9);
  EXPECT_EQ(tables[1].rows[1].transmitter_id, 5);
}

TEST_F(LinkTableTest, RangeAndDelayAreThoseOfThePositionsAtTheInstant) {
  EXPECT_EQ(fleet_.add_state("v1", 1, state_at(0, {0, 0, 50})), "");
  EXPECT_EQ(fleet_.add_state("v2", 2, state_at(0, {1500, 0, 50}, {10, 0, 0})), "");
  const auto row = tables_at(3)[0].rows[0];
  EXPECT_NEAR(row.budget.range_m, 1530, tolerance(1e-9));
  EXPECT_NEAR(row.budget.delay_s, 1530 / kSpeedMps, tolerance(1e-12));
  EXPECT_EQ(row.transmitter_age, for_s(3));
}

TEST_F(LinkTableTest, RowsHoldTheForecastOfTheirPaths) {
  EXPECT_EQ(fleet_.add_state("v1", 1, state_at(0, {0, 0, 50})), "");
  EXPECT_EQ(fleet_.add_state("v2", 2, state_at(0, {1500, 0, 50})), "");
  const auto placed = place_all(fleet_, at_s(1));
  const acoustics::Modem& modem = placed[0].modem->modem;
  const Reception reception = propagation_.reception(at_s(1), link_end(placed[0]), link_end(placed[1]));
  const LinkForecast by_hand =
      predictor_.forecast(*predictor_.rates_of(modem), modem, placed[1].modem->modem, reception);
  const LinkForecast forecast = tables_at(1)[0].rows[0].forecast;
  EXPECT_EQ(forecast.first_path_delay_s, reception.budget.delay_s);
  EXPECT_EQ(forecast.sinr_db, by_hand.sinr_db);
  EXPECT_EQ(forecast.delivery_probability, by_hand.delivery_probability);
  EXPECT_EQ(forecast.best_rate_bps, by_hand.best_rate_bps);
}

// Everywhere louder by so much than the ambient noise.
class LouderNoise : public ReceiverNoise {
 public:
  explicit LouderNoise(Decibels more) : more_(more) {}
  bool differ() const override { return true; }
  Decibels above_ambient(const EndPair&, SimTime, VehicleId) override { return more_; }
  bool is_ready(const EndPair&, SimTime, VehicleId) override { return true; }

 private:
  Decibels more_;
};

// 7 dB more: both ratios fall by them, the capacity is that of the kernel, and what is delivered is that of a
// link that is weaker by them.
TEST_F(LinkTableTest, AnotherNoiseMovesRatiosCapacityAndForecasts) {
  EXPECT_EQ(fleet_.add_state("v1", 1, state_at(0, {0, 0, 50})), "");
  EXPECT_EQ(fleet_.add_state("v2", 2, state_at(0, {1500, 0, 50})), "");
  const auto placed = place_all(fleet_, at_s(1));
  const LinkRow ambient = tables_at(1)[0].rows[0];
  LouderNoise louder(Decibels{7});
  NoiseOfLinks noise(louder, at_s(1));
  const LinkRow row = link_tables(at_s(1), placed, table_rows(placed), propagation_, predictor_,
                                  one_after_the_other, &noise)[0]
                          .rows[0];
  EXPECT_NEAR((ambient.budget.snr - row.budget.snr).value, 7, tolerance(1e-9));
  EXPECT_NEAR((ambient.budget.snr_narrowband - row.budget.snr_narrowband).value, 7, tolerance(1e-9));
  EXPECT_NEAR(ambient.forecast.sinr_db - row.forecast.sinr_db, 7, tolerance(1e-9));
  EXPECT_EQ(ambient.budget.received_level, row.budget.received_level);
  const acoustics::Modem& modem = placed[0].modem->modem;
  const acoustics::LinkBudget by_kernel =
      acoustics::LinkKernel(even_water(), modem, modem)
          .budget({0, 0, 50}, {1500, 0, 50}, acoustics::Capacity::kComputed, Decibels{7});
  EXPECT_EQ(row.budget.capacity_bps, by_kernel.capacity_bps);
  EXPECT_LT(row.budget.capacity_bps, ambient.budget.capacity_bps);
}

TEST_F(LinkTableTest, ReceiversBeyondATransmittersRangeAreCounted) {
  EXPECT_EQ(fleet_.add_state("v1", 1, state_at(0, {0, 0, 50})), "");
  EXPECT_EQ(fleet_.add_state("v2", 2, state_at(0, {500, 0, 50})), "");
  EXPECT_EQ(fleet_.add_state("v3", 3, state_at(0, {1500, 0, 50})), "");
  const auto placed = place_all(fleet_, at_s(1));
  const auto tables =
      link_tables(at_s(1), placed, table_rows(placed, {600, 1100, 0}), propagation_, predictor_);
  ASSERT_EQ(tables.size(), 3u);
  EXPECT_EQ(tables[0].range_m, 600);
  ASSERT_EQ(tables[0].rows.size(), 1u);
  EXPECT_EQ(tables[0].rows[0].receiver_id, 2);
  EXPECT_EQ(tables[0].out_of_range, 1u);
  EXPECT_EQ(tables[1].rows.size(), 2u);
  EXPECT_EQ(tables[1].out_of_range, 0u);
  EXPECT_TRUE(tables[2].rows.empty());
  EXPECT_EQ(tables[2].out_of_range, 2u);
}

TEST_F(LinkTableTest, AVehicleAloneHasAnEmptyTable) {
  EXPECT_EQ(fleet_.add_state("v1", 1, state_at(0, {0, 0, 50})), "");
  const auto tables = tables_at(1);
  ASSERT_EQ(tables.size(), 1u);
  EXPECT_TRUE(tables[0].rows.empty());
}

TEST_F(LinkTableTest, AVehicleWhoseStateGrewOldLeavesTheTables) {
  EXPECT_EQ(fleet_.add_state("v1", 1, state_at(0, {0, 0, 50})), "");
  EXPECT_EQ(fleet_.add_state("v2", 2, state_at(4, {9, 0, 50})), "");
  EXPECT_EQ(tables_at(4.9).size(), 2u);
  const auto tables = tables_at(5.5);
  ASSERT_EQ(tables.size(), 1u);
  EXPECT_EQ(tables[0].vehicle_id, 2);
}

TEST_F(LinkTableTest, EachDirectionHasTheLevelOfItsTransmitter) {
  VehicleModem loud = quick_modem();
  loud.modem.source_level = quick_modem().modem.source_level + Decibels{7};
  fleet_.announce_modem("v1", at_s(0), loud, at_s(0));
  EXPECT_EQ(fleet_.add_state("v1", 1, state_at(0, {0, 0, 50})), "");
  EXPECT_EQ(fleet_.add_state("v2", 2, state_at(0, {500, 0, 50})), "");
  const auto tables = tables_at(1);
  const double there = tables[0].rows[0].budget.received_level.value;
  const double back = tables[1].rows[0].budget.received_level.value;
  EXPECT_NEAR(there - back, 7, tolerance(1e-9));
}

// The receiver of the second row is deaf to echoes.
TEST_F(LinkTableTest, RowsHoldTheMultipathOfTheirOwnDirection) {
  VehicleModem deaf = quick_modem();
  deaf.modem.min_receivable_level = quick_modem().modem.source_level;
  fleet_.announce_modem("v1", at_s(0), deaf, at_s(0));
  EXPECT_EQ(fleet_.add_state("v1", 1, state_at(0, {0, 0, 50})), "");
  EXPECT_EQ(fleet_.add_state("v2", 2, state_at(0, {500, 0, 50})), "");
  EXPECT_EQ(tables_at(1)[0].rows[0].multipath, Multipath::kUnknown);
  StraightPropagation over_bottom(
      std::make_shared<const EnvironmentTimeline>(even_water()), {},
      testing::seabed_around({0, 0, 50}, {500, 0, 50}, [](double) { return 100.0; }));
  const auto placed = place_all(fleet_, at_s(1));
  const auto tables = link_tables(at_s(1), placed, table_rows(placed), over_bottom, predictor_);
  EXPECT_EQ(tables[0].rows[0].multipath, Multipath::kLikely);
  EXPECT_EQ(tables[1].rows[0].multipath, Multipath::kUnlikely);
}

// A wall beside the first vehicle, which lies deeper than its crest, hides the bottom beyond it. Read from
// the wrong end it would stand beside the other vehicle, which looks over it.
TEST_F(LinkTableTest, BothDirectionsOfAPairReadTheSeabedFromTheirOwnEnd) {
  const Vec3 deep(0, 0, 95), shallow(900, 0, 5);
  const auto wall = [](double north_m) { return north_m > 60 && north_m < 140 ? 60.0 : 100.0; };
  const auto seabed = testing::seabed_around(deep, shallow, wall);
  StraightPropagation over_wall(std::make_shared<const EnvironmentTimeline>(even_water()), {}, seabed);
  const acoustics::Modem& modem = quick_modem().modem;
  const acoustics::LinkKernel kernel(even_water(), modem, modem);
  const LinkEnd ends[] = {{1, deep, Vec3::Zero(), &modem}, {2, shallow, Vec3::Zero(), &modem}};
  const std::vector<EndPair> links = {{ends[0], ends[1]}, {ends[1], ends[0]}};
  const std::vector<Reception> rows = over_wall.receptions(at_s(1), links, one_after_the_other);
  for (std::size_t i = 0; i < links.size(); ++i) {
    const Vec3 &from = links[i].from.position_ned_m, &to = links[i].to.position_ned_m;
    std::array<double, acoustics::kBottomDepths> z_m{};
    ASSERT_TRUE(seabed->read_between(from, to, z_m));
    const bool is_likely = is_echo_likely(kernel, from, to, z_m);
    EXPECT_EQ(rows[i].bottom_echo, is_likely ? Multipath::kLikely : Multipath::kUnlikely);
    EXPECT_EQ(over_wall.reception(at_s(1), links[i].from, links[i].to).bottom_echo, rows[i].bottom_echo);
    std::ranges::reverse(z_m);
    EXPECT_NE(is_echo_likely(kernel, from, to, z_m), is_likely);
  }
}

}  // namespace
}  // namespace halocline::channel_server
