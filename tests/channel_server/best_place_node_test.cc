// SPDX-License-Identifier: BSD-3-Clause
// BEST_PLACE_QUERY and its reply.
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acoustics/modem/modem.h"
#include "acoustics/noise/noise_spectrum.h"
#include "acoustics/sea/noise.h"
#include "bus/transport/event_log.h"
#include "channel_server/links/best_place_service.h"
#include "channel_server/vehicles/vehicle_equipment.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_noise.h"
#include "core/sim_time.h"
#include "core/units.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/channel_server/flat_bottom.h"
#include "tests/channel_server/link_queries.h"
#include "tests/channel_server/node_bench.h"
#include "tests/channel_server/water_models.h"

namespace halocline::channel_server {
namespace {

using testing::FlatBottom;
using ::testing::HasSubstr;
using testing::NodeBench;

class BestPlaceTest : public ::testing::Test {
 protected:
  BestPlaceTest()
      : bench_({}, {testing::quick_modem(), {}}, ray_model(testing::even_water(), {}, {})),
        bottom_(bench_.lcm(), 100) {
    bus::set_log_level(bus::LogLevel::kSilent);
    bench_.bus().subscribe<best_place_reply_t>(
        "BEST_PLACE_REPLY.tester", [this](const best_place_reply_t& m) { replies_.push_back(m); });
    bench_.state(1, 0, {0, 0, 50});
    bench_.state(2, 0, {4000, 0, 50});
    bench_.step(1);
  }

  void publish(const std::vector<Vec3>& places, const std::vector<std::string>& listeners,
               const std::string& talker = "", double asked_for_s = 0) {
    best_place_query_t query{};
    query.utime = at_s(asked_for_s).to_utime();
    query.client_name = "tester";
    query.request_id = ++requests_;
    query.talker_name = talker;
    query.num_places = static_cast<std::int32_t>(places.size());
    for (const Vec3& place : places) query.place_ned_m.push_back({place.x(), place.y(), place.z()});
    query.num_listeners = static_cast<std::int32_t>(listeners.size());
    query.listener_name = listeners;
    bench_.bus().publish("BEST_PLACE_QUERY", query);
  }
  best_place_reply_t reply_to(const std::vector<Vec3>& places, const std::vector<std::string>& listeners,
                              const std::string& talker = "", double asked_for_s = 0) {
    replies_.clear();
    publish(places, listeners, talker, asked_for_s);
    bench_.step(1);
    return replies_.at(0);
  }
  void expect_refused(const std::vector<Vec3>& places, const std::vector<std::string>& listeners,
                      const std::string& talker, const std::string& text) {
    const auto reply = reply_to(places, listeners, talker);
    EXPECT_EQ(reply.reply_status, best_place_reply_t::REFUSED);
    EXPECT_THAT(reply.refusal, HasSubstr(text));
    EXPECT_EQ(reply.best_place, -1);
    EXPECT_EQ(reply.num_places, 0);
  }
  static SimTime at_s(double s) { return SimTime::from_seconds(s); }

  NodeBench bench_;
  FlatBottom bottom_;
  std::vector<best_place_reply_t> replies_;
  std::int64_t requests_ = 0;
};

TEST_F(BestPlaceTest, ScoresAreThoseOfTheLinks) {
  const std::vector<Vec3> places{{2000, 0, 30}, {3000, 0, 80}, {-2000, 500, 50}};
  const auto reply = reply_to(places, {"v1", "v2"});
  ASSERT_EQ(reply.num_places, 3);
  std::vector<std::pair<link_end_t, link_end_t>> links;
  for (const Vec3& place : places) {
    for (const char* listener : {"v1", "v2"}) {
      link_end_t from = testing::at(place.x(), place.z());
      from.position_ned_m[1] = place.y();
      links.emplace_back(from, testing::named(listener));
    }
  }
  bench_.bus().publish("LINK_QUERY", testing::link_query(links, 1));
  bench_.step(1);
  const auto& answers = bench_.replies.at(0).message.answers;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const link_t &one = answers.at(2 * i).link, &two = answers.at(2 * i + 1).link;
    EXPECT_NEAR(reply.mean_delivery[i], 0.5 * (one.delivery_probability + two.delivery_probability), 1e-12);
    EXPECT_EQ(reply.least_delivery[i], std::min(one.delivery_probability, two.delivery_probability));
    EXPECT_NEAR(reply.mean_sinr_db[i], 0.5 * (one.sinr_db + two.sinr_db), 1e-9);
  }
}

// With one listener the nearer place is louder, whatever the surface and the bottom add.
TEST_F(BestPlaceTest, TheNearerPlaceIsBetter) {
  EXPECT_EQ(reply_to({{6000, 0, 50}, {300, 0, 50}, {2500, 0, 50}}, {"v1"}).best_place, 1);
}

TEST_F(BestPlaceTest, PlacesOutOfTheWaterAreNone) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto reply = reply_to({{300, 0, -1}, {300, 0, 150}, {kNan, 0, 50}, {2000, 0, 50}}, {"v1"});
  EXPECT_EQ(reply.best_place, 3);
  for (const std::size_t i : {0, 1, 2}) {
    EXPECT_EQ(reply.mean_delivery[i], 0);
    EXPECT_EQ(reply.mean_sinr_db[i], kSilence.value);
  }
  EXPECT_EQ(reply_to({{300, 0, -1}}, {"v1"}).best_place, -1);
}

TEST_F(BestPlaceTest, ListenersAreWhereTheyAreAtTheTimeAskedFor) {
  bench_.state(1, 1, {0, 0, 50}, {20, 0, 0});
  bench_.step(1);
  const auto now = reply_to({{500, 0, 50}}, {"v1"}, "", 1), soon = reply_to({{500, 0, 50}}, {"v1"}, "", 1.9);
  EXPECT_EQ(now.utime, 1'000'000);
  EXPECT_EQ(soon.utime, 1'900'000);
  EXPECT_EQ(reply_to({{500, 0, 50}}, {"v1"}, "", 100).utime, 2'000'000);  // as near as it may be
}

TEST_F(BestPlaceTest, ImpossibleQueriesAreRefusedWithClearWords) {
  expect_refused({{0, 0, 50}}, {"ghost"}, "", "ghost is unknown");
  expect_refused({{0, 0, 50}}, {"Not A Name"}, "", "no name");
  expect_refused({{0, 0, 50}}, {"v1"}, "v1", "talker itself");
  expect_refused({{0, 0, 50}}, {"v1"}, "Not A Name", "talker_name");
  expect_refused(std::vector<Vec3>(801, Vec3(0, 0, 50)), {"v1", "v2"}, "", "1 to 1600");
}

TEST_F(BestPlaceTest, ItWaitsForTheSeabedAndGoesStraightWithoutIt) {
  bottom_.hold();
  publish({{20'000, 0, 50}}, {"v1"});
  bench_.step(SimTime::from_seconds(1), SimTime::from_seconds(10));
  EXPECT_TRUE(replies_.empty());
  bottom_.release();
  bench_.step(SimTime::from_seconds(1), SimTime::from_seconds(10.1));
  ASSERT_EQ(replies_.size(), 1);
  bottom_.set_away(true);
  publish({{-20'000, 0, 50}}, {"v1"});
  bench_.step(SimTime::from_seconds(1), SimTime::from_seconds(11));
  EXPECT_EQ(replies_.size(), 1);
  bench_.step(SimTime::from_seconds(1), SimTime::from_seconds(11.3));
  ASSERT_EQ(replies_.size(), 2);
  EXPECT_EQ(replies_[1].best_place, 0);
}

// 5 kHz of 100 dB at 1 m: of the listener itself, 20 dB less; of another vehicle 300 m away; of the talker
// none.
TEST(BestPlaceAmongNoise, ListenersHearTheirOwnNoiseAndThatOfOthersButTheTalker) {
  bus::set_log_level(bus::LogLevel::kSilent);
  const auto sinr_of = [](const std::string& loud, const std::string& talker) {
    const acoustics::NoiseSpectrum spectrum({1e3}, {100});
    const VehicleId id = loud == "v1" ? 1 : 2;
    const VehicleEquipment equipment{
        .noise = VehicleNoise({{loud, id, spectrum, NoiseDriver::kNone, 1, Decibels{20}}}, SimDuration())};
    NodeBench bench({}, {testing::quick_modem(), {}}, testing::without_bottom(testing::even_water()),
                    equipment);
    std::vector<best_place_reply_t> replies;
    bench.bus().subscribe<best_place_reply_t>("BEST_PLACE_REPLY.tester",
                                              [&](const best_place_reply_t& m) { replies.push_back(m); });
    bench.state(1, 0, {0, 0, 50});
    bench.state(2, 0, {300, 0, 50});
    bench.step(1);
    best_place_query_t query{};
    query.client_name = "tester";
    query.talker_name = talker;
    query.num_places = query.num_listeners = 1;
    query.place_ned_m = {{1000, 0, 50}};
    query.listener_name = {"v1"};
    bench.bus().publish("BEST_PLACE_QUERY", query);
    bench.step(1);
    return replies.at(0).mean_sinr_db.at(0);
  };
  const double quiet_db = sinr_of("v2", "v2"), own_db = sinr_of("v1", "v2"), beside_db = sinr_of("v2", "");
  const auto band = testing::quick_modem().modem.band();
  const double ambient =
      acoustics::noise_power_over_band(band.low_hz, band.high_hz, testing::even_water().noise).value;
  EXPECT_NEAR(quiet_db - own_db, 10 * std::log10(1 + 5000 * 1e8 / ambient), 1e-6);
  EXPECT_GT(quiet_db - beside_db, 3);
}

TEST(BestPlace, OfEqualDeliveryTheGreaterRatioWins) {
  const auto score = [](double delivery, double sinr_db) {
    return PlaceScore{delivery, delivery, sinr_db, true};
  };
  EXPECT_EQ(best_of({score(0.5, 10), score(0.5, 12), score(0.4, 30)}), 1);
  EXPECT_EQ(best_of({score(1, 10), score(1, 10)}), 0);
  EXPECT_EQ(best_of({PlaceScore(), score(0, -40)}), 1);
  EXPECT_EQ(best_of({PlaceScore()}), std::nullopt);
}

}  // namespace
}  // namespace halocline::channel_server
