// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/pages/page_session.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/check.h"
#include "tests/viewer/run_for_pages.h"
#include "viewer/pages/packet_json.h"

namespace halocline::monitor {
namespace {

using nlohmann::json;

struct Page {
  explicit Page(const Source& source)
      : session(source, false, [this](const std::string& message, bool binary) {
          (binary ? frames : texts).push_back(message);
        }) {}

  // What came of one tick, by type.
  std::vector<json> tick(double steady_s, const std::string& type, bool idle = true) {
    texts.clear();
    frames.clear();
    session.tick(steady_s, idle, packets);
    std::vector<json> found;
    for (const std::string& text : texts) {
      json message = json::parse(text);
      if (message["type"] == type) found.push_back(std::move(message));
    }
    return found;
  }
  void ask(const std::string& request) { ASSERT_TRUE(session.take(json::parse(request))); }

  std::vector<std::string> texts, frames;
  PacketIndex packets;
  PageSession session;
};

TEST(PageSession, GreetsOnceThenRunAndState) {
  const testing::FixedSource source(true);
  Page page(source);
  page.session.tick(0, true, page.packets);
  ASSERT_GE(page.texts.size(), 3u);
  const json hello = json::parse(page.texts[0]);
  EXPECT_EQ(hello["type"], "hello");
  EXPECT_EQ(hello["source"], "log");
  EXPECT_EQ(hello["end_s"], 100);
  EXPECT_EQ(hello["link_columns"][0]["key"], "snr_db");
  EXPECT_EQ(json::parse(page.texts[1])["type"], "run");
  EXPECT_EQ(json::parse(page.texts[1])["vehicles"].size(), 2u);
  EXPECT_EQ(json::parse(page.texts[2])["type"], "state");
  EXPECT_TRUE(page.tick(0.05, "hello").empty());
}

TEST(PageSession, LogShowsPacketsAsTheyDepart) {
  const testing::FixedSource source(true);
  Page page(source);
  EXPECT_TRUE(page.tick(0, "packets").empty());
  page.ask(R"({"ask":"play","id":1})");
  EXPECT_TRUE(page.tick(9, "packets").empty());
  const auto found = page.tick(10.1, "packets");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0]["items"][0]["depart_s"], 10);
  EXPECT_TRUE(page.tick(10.2, "packets").empty());
}

TEST(PageSession, SeekShowsThePacketsOfTheMinuteBefore) {
  const testing::FixedSource source(true);
  Page page(source);
  page.tick(0, "packets");
  page.ask(R"({"ask":"seek","id":1,"time_s":65})");
  const auto found = page.tick(0.1, "packets");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0]["items"].size(), 2u);
  EXPECT_EQ(page.frames.size(), 1u);
}

TEST(PageSession, BusShowsAPacketAgainWhenItsOutcomeCame) {
  testing::FixedSource source(false);
  Page page(source);
  page.tick(0, "packets");
  testing::add(source.timeline(), "SEND.auv-2", clients::testing::send(9, 5, 100 * testing::kSecond));
  ASSERT_EQ(page.tick(0.05, "packets").size(), 1u);
  EXPECT_TRUE(page.tick(0.1, "packets").empty());
  testing::add(source.timeline(), "OUTCOME", clients::testing::outcome(9, 4, 5, 100 * testing::kSecond));
  const auto found = page.tick(0.15, "packets");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0]["items"][0]["outcomes"].size(), 1u);
}

TEST(PageSession, SlowConnectionGetsNoFrames) {
  const testing::FixedSource source(false);
  Page page(source);
  page.tick(0, "hello", /*idle=*/false);
  EXPECT_TRUE(page.frames.empty());
  page.tick(0.05, "hello");
  EXPECT_EQ(page.frames.size(), 1u);
  page.tick(0.1, "hello");
  EXPECT_TRUE(page.frames.empty());  // nothing has changed
}

TEST(PageSession, StateComesOnceASecondAndAtOnceWhenItChanges) {
  testing::FixedSource source(false);
  Page page(source);
  EXPECT_EQ(page.tick(10, "state").size(), 1u);
  EXPECT_TRUE(page.tick(10.5, "state").empty());
  EXPECT_EQ(page.tick(11.1, "state").size(), 1u);
  source.state_.bathymetry = true;
  EXPECT_EQ(page.tick(11.4, "state").size(), 1u);
  page.ask(R"({"ask":"pause","id":1})");
  EXPECT_EQ(page.tick(11.45, "state")[0]["playing"], false);
}

TEST(PageSession, WatchedColumnsComeWhenTheyChange) {
  const testing::FixedSource source(true);
  Page page(source);
  page.ask(R"({"ask":"watch","id":1,"columns":["snr_db"]})");
  page.ask(R"({"ask":"seek","id":2,"time_s":61})");
  page.tick(100, "state");
  ASSERT_EQ(page.frames.size(), 2u);
  EXPECT_EQ(page.frames[1][0], 3);
  EXPECT_EQ(page.frames[1].size(), 24u);
  page.tick(101.5, "state");
  EXPECT_TRUE(page.frames.empty());
  EXPECT_THROW(static_cast<void>(page.session.take(json::parse(R"({"ask":"watch","id":1,"columns":["x"]})"))),
               InvalidArgument);
}

TEST(PageSession, LogHasNothingNewer) {
  const testing::FixedSource source(true);
  Page page(source);
  EXPECT_THROW(static_cast<void>(page.session.take(json::parse(R"({"ask":"live","id":1})"))),
               InvalidArgument);
  EXPECT_FALSE(page.session.take(json::parse(R"({"ask":"packets","id":1})")));
}

}  // namespace
}  // namespace halocline::monitor
