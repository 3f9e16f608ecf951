// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/sim_time.h"
#include "runs/foxglove/foxglove_messages.h"
#include "runs/foxglove/foxglove_schemas.h"
#include "runs/foxglove/foxglove_session.h"
#include "tests/viewer/run_for_pages.h"

namespace halocline::clients {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

void place(RunTimeline& timeline) {
  RunScenario scenario = timeline.scenario();
  scenario.origin = {30, -28};
  timeline.set_scenario(scenario);
}

TEST(FoxgloveMessages, SchemasAreJson) {
  for (const FoxgloveSchema* schema : {&kSceneUpdateSchema, &kLocationFixSchema, &kLogSchema})
    EXPECT_EQ(json::parse(schema->json_schema)["title"], schema->name);
}

TEST(FoxgloveMessages, SceneIsEastNorthUp) {
  const auto timeline = monitor::testing::small_run();
  const json scene = foxglove_scene(timeline, SimTime::from_seconds(30), {});
  const json& arrow = scene["entities"][1]["arrows"][0];
  EXPECT_EQ(arrow["pose"]["position"], json({{"x", 1500}, {"y", 0}, {"z", -50}}));
  // It points north: a quarter turn from east.
  EXPECT_NEAR(arrow["pose"]["orientation"]["z"].get<double>(), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(arrow["pose"]["orientation"]["w"].get<double>(), std::sqrt(0.5), 1e-12);
}

TEST(FoxgloveMessages, FixIsOnTheEarth) {
  auto timeline = monitor::testing::small_run();
  EXPECT_FALSE(frame_of(timeline));
  place(timeline);
  const json fix = foxglove_fix(timeline.vehicles()[1], *frame_of(timeline), SimTime::from_seconds(30));
  EXPECT_NEAR(fix["longitude"].get<double>(),
              -28 + 1500 / (6378137 * std::cos(30 * 3.14159265 / 180)) * 180 / 3.14159265, 2e-5);
  EXPECT_NEAR(fix["latitude"].get<double>(), 30, 1e-5);
  EXPECT_EQ(fix["altitude"], -50);
}

TEST(FoxgloveMessages, LossIsAWarning) {
  const auto timeline = monitor::testing::small_run();
  const json log = foxglove_log_of(timeline, timeline.packets().all()[1].outcomes[0]);
  EXPECT_EQ(log["level"], 3);
  EXPECT_EQ(log["name"], "auv-2");
  EXPECT_THAT(log["message"], HasSubstr("Packet 1 of auv-1: Lost at auv-2"));
}

struct Client {
  std::vector<json> texts;
  std::vector<std::string> data;
  FoxgloveSession session{"test", [this](const std::string& message, bool binary) {
                            if (binary)
                              data.push_back(message);
                            else
                              texts.push_back(json::parse(message));
                          }};
};

TEST(FoxgloveSession, AdvertisesAndSendsWhatIsSubscribed) {
  auto timeline = monitor::testing::small_run();
  place(timeline);
  Client client;
  EXPECT_EQ(client.texts[0]["op"], "serverInfo");
  client.session.tick(0, true, timeline, SimTime::from_seconds(11));
  ASSERT_EQ(client.texts.size(), 5u);
  EXPECT_EQ(client.texts[3]["channels"][0]["topic"], "/vehicles/auv-1/position");
  ASSERT_EQ(client.data.size(), 1u);  // the time
  client.session.take(
      R"({"op":"subscribe","subscriptions":[{"id":7,"channelId":1},{"id":8,"channelId":3},{"id":9,)"
      R"("channelId":2}]})");
  client.session.tick(0.2, true, timeline, SimTime::from_seconds(12));
  ASSERT_EQ(client.data.size(), 4u);
  EXPECT_EQ(client.data[2].substr(0, 5), std::string("\1\7\0\0\0", 5));
  EXPECT_EQ(json::parse(client.data[2].substr(13))["entities"].size(), 4u);  // two vehicles, links, one wave
  client.session.tick(0.4, true, timeline, SimTime::from_seconds(13));
  EXPECT_EQ(json::parse(client.data.back().substr(13))["name"], "auv-2");
  client.session.take(R"({"op":"unsubscribe","subscriptionIds":[7,8,9]})");
  client.data.clear();
  client.session.tick(0.6, true, timeline, SimTime::from_seconds(14));
  EXPECT_EQ(client.data.size(), 1u);
}

TEST(FoxgloveSession, WhatIsNoRequestIsAnsweredByAStatus) {
  Client client;
  for (const char* wrong : {"", "[]", "{}", R"({"op":"subscribe"})",
                            R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":"x"}]})", "\xff"}) {
    client.session.take(wrong);
    EXPECT_EQ(client.texts.back()["op"], "status") << wrong;
  }
}

}  // namespace
}  // namespace halocline::clients
