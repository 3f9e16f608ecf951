// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/pages/requests.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/check.h"
#include "tests/viewer/run_for_pages.h"
#include "viewer/pages/link_display.h"
#include "viewer/pages/packet_json.h"

namespace halocline::monitor {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

json answer(const std::string& request) {
  const clients::RunTimeline timeline = testing::small_run();
  PacketIndex packets;
  return answer_request(timeline, packets, json::parse(request));
}

std::string refusal(const std::string& request) {
  try {
    answer(request);
  } catch (const InvalidArgument& problem) {
    return problem.what();
  }
  return "";
}

TEST(Requests, PacketsOfAWindowAreThoseThatDepartInIt) {
  const json reply = answer(R"({"ask":"packets","id":1,"from_s":5,"to_s":50})");
  ASSERT_EQ(reply["items"].size(), 2u);
  const json& first = reply["items"][0];
  EXPECT_EQ(first["source"], 0);
  EXPECT_EQ(first["destination"], -1);
  EXPECT_EQ(first["depart_s"], 10);
  EXPECT_EQ(first["duration_s"], 2);
  EXPECT_EQ(first["north_m"], 10);
  EXPECT_EQ(first["result"], "accepted");
  EXPECT_EQ(first["outcomes"][0]["receiver"], 1);
  EXPECT_EQ(first["outcomes"][0]["arrive_s"], 11);
  EXPECT_EQ(first["outcomes"][0]["end_s"], 13);
  EXPECT_EQ(reply["truncated"], false);
}

TEST(Requests, RefusedPacketHasNoDurationAndSaysWhy) {
  const json packet = answer(R"({"ask":"packets","id":1,"from_s":80,"to_s":100})")["items"][0];
  EXPECT_EQ(packet["result"], "refused_busy");
  EXPECT_EQ(packet["duration_s"], 0);
  const json reply = answer(R"({"ask":"packet","id":1,"receiver":1,"key":)" + packet["key"].dump() + "}");
  EXPECT_THAT(reply["sentence"], HasSubstr("still transmitting"));
}

TEST(Requests, OverviewCountsPacketsAndOutcomesByBin) {
  const json reply = answer(R"({"ask":"overview","id":1,"from_s":0,"to_s":100,"bins":2})");
  EXPECT_EQ(reply["sent"], json({1, 1}));
  EXPECT_EQ(reply["received"], json({1, 0}));
  EXPECT_EQ(reply["lost"], json({0, 1}));
}

TEST(Requests, PacketHasItsLadderAndSentence) {
  const json packet = answer(R"({"ask":"packets","id":1,"from_s":50,"to_s":50})")["items"][0];
  const json reply = answer(R"({"ask":"packet","id":1,"receiver":1,"key":)" + packet["key"].dump() + "}");
  EXPECT_EQ(reply["code"], packet_outcome_t::BELOW_CUTOFF);
  EXPECT_THAT(reply["sentence"], HasSubstr("Lost at auv-2"));
  EXPECT_FALSE(reply["ladder"].empty());
}

TEST(Requests, RowIsInUnitsForPeople) {
  const json values = answer(R"({"ask":"row","id":1,"from":0,"to":1,"time_s":61})")["values"];
  ASSERT_EQ(values.size(), link_displays().size());
  EXPECT_EQ(values[0], 12);
  EXPECT_EQ(values[find_display("delay_spread_s")], 4);
  EXPECT_NEAR(values[find_display("first_path_doppler_factor")], 200, 1e-6);
  EXPECT_EQ(values[find_display("delivery_probability")], 25);
  EXPECT_EQ(values[find_display("received_share")], 50);
  EXPECT_TRUE(
      std::isnan(answer(R"({"ask":"row","id":1,"from":1,"to":0,"time_s":61})")["values"][0].get<double>()));
}

TEST(Requests, PairHasItsHistoryAndPackets) {
  const json reply =
      answer(R"({"ask":"pair","id":1,"from":0,"to":1,"column":"snr_db","from_s":0,"to_s":100})");
  EXPECT_EQ(reply["time_s"], json({60}));
  EXPECT_EQ(reply["value"], json({12}));
  EXPECT_EQ(reply["packets"].size(), 2u);
}

TEST(Requests, TracksAreThinned) {
  const json tracks = answer(R"({"ask":"tracks","id":1,"from_s":0,"to_s":100,"max_points":20})")["tracks"];
  ASSERT_EQ(tracks.size(), 2u);
  EXPECT_LE(tracks[0]["time_s"].size(), 20u);
  EXPECT_EQ(tracks[0]["north_m"].back(), 100);
}

TEST(Requests, VehicleHasPanelsOfWhatIsKnown) {
  const json reply = answer(R"({"ask":"vehicle","id":1,"vehicle":0,"from_s":0,"to_s":100})");
  EXPECT_EQ(reply["panels"][0]["key"], "depth");
  EXPECT_EQ(reply["panels"][0]["series"].size(), 1u);
  EXPECT_TRUE(reply["estimate"].is_null());
}

TEST(Requests, WhatCannotBeIsRefusedWithASentence) {
  EXPECT_THAT(refusal(R"({"ask":"row","id":1,"from":0,"to":7,"time_s":61})"), HasSubstr("to is 7"));
  EXPECT_THAT(refusal(R"({"ask":"row","id":1,"from":0.5,"to":1,"time_s":61})"), HasSubstr("whole number"));
  EXPECT_THAT(refusal(R"({"ask":"tracks","id":1,"from_s":"x","to_s":1})"), HasSubstr("from_s"));
  EXPECT_THAT(refusal(R"({"ask":"overview","id":1,"from_s":5,"to_s":5,"bins":3})"), HasSubstr("not after"));
  EXPECT_THAT(refusal(R"({"ask":"overview","id":1,"from_s":0,"to_s":5,"bins":3000})"), HasSubstr("bins"));
  EXPECT_THAT(refusal(R"({"ask":"packet","id":1,"key":"p99","receiver":1})"), HasSubstr("p99"));
  EXPECT_THAT(refusal(R"({"ask":"packet","id":1,"key":"p","receiver":1})"), HasSubstr("not known"));
  EXPECT_THAT(refusal(R"({"ask":"pair","id":1,"from":0,"to":1,"column":"x","from_s":0,"to_s":1})"),
              HasSubstr("column x"));
  EXPECT_THAT(refusal(R"({"ask":"dance","id":1})"), HasSubstr("dance"));
  EXPECT_THROW(request_id(json::parse("[]")), InvalidArgument);
  EXPECT_THROW(request_id(json::parse(R"({"ask":"x"})")), InvalidArgument);
}

}  // namespace
}  // namespace halocline::monitor
