// SPDX-License-Identifier: BSD-3-Clause
// What a recorder of all channels gets of their flows, and what it lacks.
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>

#include "bus/bus.h"
#include "bus/messages/message_codec.h"
#include "bus/messages/sequence_number.h"
#include "bus/repair/flow_watch.h"
#include "core/sim_time.h"
#include "tests/bus/messages_for_tests.h"
#include "tests/support/at_ms.h"

namespace halocline::bus {
namespace {

using halocline::testing::at_ms;
using ::testing::ElementsAre;
using testing::valid_message;

// Subscribes as a recorder does, with the flows of STATE alone.
class FlowsOfAllTest : public ::testing::Test {
 protected:
  FlowsOfAllTest() {
    bus_.subscribe_to_all_flows(
        [](std::string_view channel, std::span<const std::uint8_t> bytes) -> std::optional<FlowHead> {
          vehicle_state_t state;
          if (!channel.starts_with("STATE.") || !decode(bytes, state).empty()) return std::nullopt;
          return FlowHead{state.session, state.sequence, state.utime, {}, channel == "STATE.repeating"};
        },
        [this](std::string_view channel, const void*, std::size_t) { recorded_.emplace_back(channel); });
    bus_.enable_repair();
  }
  void publish_raw(const std::string& channel, const std::vector<std::uint8_t>& bytes) {
    lcm_.publish(channel, bytes.data(), static_cast<unsigned>(bytes.size()));
    drain();
  }
  void drain() {
    while (lcm_.handleTimeout(0) > 0) {
    }
  }
  void publish_state(const std::string& channel, std::int64_t sequence) {
    auto state = valid_message<vehicle_state_t>(1);
    state.session = 7;
    state.sequence = sequence;
    publish_raw(channel, encoded(state));
  }
  lcm::LCM lcm_{"memq://"};
  Bus bus_{lcm_, {"recorder", 11}};
  std::vector<std::string> recorded_;
};

TEST_F(FlowsOfAllTest, EachMessageOfAFlowComesOnceAndARepairUnderItsOwnChannel) {
  publish_state("STATE.a", 0);
  publish_state("STATE.a", 0);
  publish_state("STATE.a", 2);
  publish_state("REPAIR.STATE.a", 1);
  publish_state("REPAIR.STATE.a", 1);
  publish_state("REPAIR.STATE.a", 2);
  EXPECT_THAT(recorded_, ElementsAre("STATE.a", "STATE.a", "STATE.a"));
  EXPECT_EQ(bus_.flows().num_missing(), 0u);
  EXPECT_EQ(bus_.counters().duplicates, 3);
}

TEST_F(FlowsOfAllTest, WhatItsSenderRepeatsComesEachTimeAndWhatRepairRepeatsOnce) {
  publish_state("STATE.repeating", 0);
  publish_state("STATE.repeating", 0);
  publish_state("REPAIR.STATE.repeating", 0);
  EXPECT_THAT(recorded_, ElementsAre("STATE.repeating", "STATE.repeating"));
}

TEST_F(FlowsOfAllTest, WhatIsOfNoFlowComesAsItIs) {
  publish_raw("anything", {1, 2, 3});
  publish_raw("anything", {1, 2, 3});
  publish_raw("REPAIR.anything", {1, 2, 3});
  EXPECT_THAT(recorded_, ElementsAre("anything", "anything", "REPAIR.anything"));
}

TEST_F(FlowsOfAllTest, WhatIsMissingIsRequestedAndNamedByChannel) {
  publish_state("STATE.a", 0);
  publish_state("STATE.a", 3);
  publish_state("STATE.b", 0);
  ASSERT_EQ(bus_.flows().lacking().size(), 1u);
  EXPECT_EQ(bus_.flows().lacking()[0].channel, "STATE.a");
  EXPECT_EQ(bus_.flows().lacking()[0].messages, 2);
  bus_.repair(SimTime(), SimTime::from_seconds(1));
  drain();
  EXPECT_THAT(recorded_, ::testing::Contains("REPAIR_REQUEST"));
}

TEST(FlowWatchLacking, CountsWhatIsMissingAndWhatExpiredUntilItComes) {
  FlowWatch watch;
  watch.on_message(at_ms(0), "STATE.b", 1, 0);
  watch.on_message(at_ms(0), "STATE.b", 1, 4);
  watch.on_message(at_ms(0), "STATE.a", 1, 0);
  watch.on_message(at_ms(0), "STATE.a", 1, 2);
  const auto counts = [&] {
    std::map<std::string, std::int64_t> all;
    for (const FlowWatch::Lacking& one : watch.lacking()) all[one.channel] = one.messages;
    return all;
  };
  EXPECT_EQ(counts(), (std::map<std::string, std::int64_t>{{"STATE.a", 1}, {"STATE.b", 3}}));
  watch.take_due(at_ms(10));
  watch.take_due(at_ms(10'001));
  EXPECT_EQ(watch.num_missing(), 0u);
  EXPECT_EQ(counts(), (std::map<std::string, std::int64_t>{{"STATE.a", 1}, {"STATE.b", 3}}));
  watch.on_message(at_ms(10'002), "STATE.b", 1, 2, true);
  watch.on_message(at_ms(10'002), "STATE.a", 1, 1, true);
  EXPECT_EQ(counts(), (std::map<std::string, std::int64_t>{{"STATE.b", 2}}));
}

TEST(FlowWatchLacking, OutlivesTheSessionsAndTheRun) {
  FlowWatch watch;
  for (std::int64_t session = 1; session <= 10; ++session) {
    const SimTime at = at_ms(40'000 * session);
    watch.on_message(at, "STATE.a", session, 0);
    watch.on_message(at, "STATE.a", session, 2);
  }
  ASSERT_EQ(watch.lacking().size(), 1u);
  EXPECT_EQ(watch.lacking()[0].messages, 10);
  watch.forget();
  ASSERT_EQ(watch.lacking().size(), 1u);
  EXPECT_EQ(watch.lacking()[0].messages, 10);
}

}  // namespace
}  // namespace halocline::bus
