// SPDX-License-Identifier: BSD-3-Clause
// A vehicle that seeks where it is heard: what it chooses, what it asks and when an answer counts.
#include "clients/onboard/autopilot/link_seeker.h"

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bus/bus.h"
#include "bus/messages/channels.h"
#include "clients/onboard/autopilot/autopilot_config.h"
#include "clients/onboard/autopilot/autopilot_node.h"
#include "core/archive.h"
#include "core/check.h"
#include "tests/support/at_ms.h"

namespace halocline::clients {
namespace {

using halocline::testing::at_ms;

Behaviour seeking() {
  Behaviour behaviour{.kind = BehaviourKind::kSeekLink, .center_north_m = 100, .radius_m = 50};
  behaviour.search = {.listeners = "lander buoy",
                      .shallowest_m = 10,
                      .deepest_m = 40,
                      .step_m = 10,
                      .period_s = 60,
                      .least_gain = 0.1};
  return behaviour;
}

TEST(LinkSeeker, PlacesAreItsWaypointsOrTheDepthsAboveItsCentre) {
  Behaviour behaviour = seeking();
  EXPECT_EQ(places_of(behaviour),
            (std::vector<Vec3>{{100, 0, 10}, {100, 0, 20}, {100, 0, 30}, {100, 0, 40}}));
  behaviour.waypoints = {{1, 2, 3}};
  EXPECT_EQ(places_of(behaviour), behaviour.waypoints);
  EXPECT_EQ(listeners_of(behaviour.search), (std::vector<std::string>{"lander", "buoy"}));
  behaviour.waypoints.clear();
  behaviour.search.step_m = 0;
  EXPECT_THROW(places_of(behaviour), InvalidArgument);
}

TEST(LinkSeeker, ItMovesForEnoughAndForAnythingWhereItIsNotHeardAtAll) {
  LinkSeeker seeker(seeking());
  EXPECT_EQ(seeker.chosen().z(), 10);
  seeker.take({0.5, 0.59, 0, 0}, 1);
  EXPECT_EQ(seeker.chosen().z(), 10);
  seeker.take({0.5, 0.61, 0, 0}, 1);
  EXPECT_EQ(seeker.chosen().z(), 20);
  seeker.take({0, 0, 0.01, 0}, 2);
  EXPECT_EQ(seeker.chosen().z(), 30);
  seeker.take({0, 0, 0, 0}, 3);  // nothing is delivered anywhere: where the ratio is best
  EXPECT_EQ(seeker.chosen().z(), 40);
}

TEST(LinkSeeker, AnswersThatDoNotFitChangeNothing) {
  LinkSeeker seeker(seeking());
  seeker.take({0, 1, 0, 0}, -1);
  seeker.take({0, 1, 0, 0}, 4);
  seeker.take({0, 1}, 1);
  EXPECT_EQ(seeker.chosen().z(), 10);
}

class SeekingAutopilotTest : public ::testing::Test {
 protected:
  SeekingAutopilotTest() {
    peer_.subscribe<best_place_query_t>(
        bus::channels::kBestPlaceQuery,
        [this](const best_place_query_t& query) { queries_.push_back(query); });
    peer_.subscribe<autopilot_status_t>(
        bus::channels::kAutopilot.of("auv-1"),
        [this](const autopilot_status_t& status) { reports_.push_back(status); });
  }
  static AutopilotConfig config() {
    AutopilotConfig config;
    config.vehicles.resize(1);
    config.vehicles[0].vehicle = "auv-1";
    config.vehicles[0].behaviours = {seeking()};
    return config;
  }
  void step_to(std::int64_t end_ms) {
    for (; now_ms_ <= end_ms; now_ms_ += 100) {
      vehicle_state_t state{};
      state.utime = now_ms_ * 1000;
      state.vehicle_id = 1;
      state.orientation_wxyz[0] = 1;
      peer_.publish(bus::channels::kState.of("auv-1"), state);
      drain();
      node_.step({at_ms(now_ms_), at_ms(now_ms_)});
      drain();
    }
  }
  void answer(std::int64_t request_id, const std::vector<double>& delivery, std::int32_t best) {
    best_place_reply_t reply{};
    reply.request_id = request_id;
    reply.best_place = best;
    reply.num_places = static_cast<std::int32_t>(delivery.size());
    reply.mean_delivery = reply.least_delivery = reply.mean_sinr_db = delivery;
    peer_.publish(bus::channels::kBestPlaceReply.of("auv-1"), reply);
    drain();
  }
  void drain() {
    while (lcm_.handleTimeout(0) > 0) continue;
  }

  lcm::LCM lcm_{"memq://"};
  AutopilotNode node_{lcm_, {"autopilot", 11}, config()};
  bus::Bus peer_{lcm_, {"peer", 1}};
  std::vector<best_place_query_t> queries_;
  std::vector<autopilot_status_t> reports_;
  std::int64_t now_ms_ = 0;
};

TEST_F(SeekingAutopilotTest, ItAsksOncePerPeriodAndTheAnswerCountsASecondLater) {
  step_to(200);
  ASSERT_EQ(queries_.size(), 1U);
  EXPECT_EQ(queries_[0].talker_name, "auv-1");
  EXPECT_EQ(queries_[0].listener_name, (std::vector<std::string>{"lander", "buoy"}));
  EXPECT_EQ(queries_[0].place_ned_m[3], (std::vector<double>{100, 0, 40}));
  answer(queries_[0].request_id, {0.1, 0.2, 0.9, 0.3}, 2);
  step_to(59'900);
  ASSERT_EQ(queries_.size(), 1U);
  for (const autopilot_status_t& report : reports_) {
    if (report.autopilot_activity != autopilot_status_t::SEEKING_LINK) continue;
    EXPECT_EQ(report.commanded_z_m, report.utime >= queries_[0].utime + 1'000'000 ? 30 : 10) << report.utime;
  }
  EXPECT_EQ(reports_.back().commanded_z_m, 30);
  step_to(60'300);
  EXPECT_EQ(queries_.size(), 2U);
}

TEST_F(SeekingAutopilotTest, WithoutAnAnswerItAsksAgainAndStrangersAreNotBelieved) {
  step_to(200);
  ASSERT_EQ(queries_.size(), 1U);
  answer(queries_[0].request_id + 5, {0, 0, 1, 0}, 2);
  step_to(2'000);
  EXPECT_EQ(queries_.size(), 2U);
  EXPECT_EQ(reports_.back().commanded_z_m, 10);
}

}  // namespace
}  // namespace halocline::clients
