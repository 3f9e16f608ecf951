// SPDX-License-Identifier: BSD-3-Clause
#include "bus/logs/log_flows.h"

#include <cstdint>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/messages/message_codec.h"
#include "bus/messages/messages.h"
#include "bus/messages/sequence_number.h"
#include "tests/bus/messages_for_tests.h"

namespace halocline::clients {
namespace {

using ::testing::HasSubstr;

class LogFlowsTest : public ::testing::Test {
 protected:
  void outcome(std::int64_t sequence, std::int64_t session = 1, std::int64_t utime = 0,
               const std::string& channel = "OUTCOME") {
    auto message = bus::testing::valid_message<packet_outcome_t>(1);
    message.utime = utime;
    message.session = session;
    message.sequence = sequence;
    flows_.count(channel, bus::encoded(message));
  }
  std::string report() const {
    std::ostringstream out;
    report_flows(out, flows_);
    return out.str();
  }
  LogFlows flows_;
};

TEST_F(LogFlowsTest, OfAWholeLogThereIsNothingToReport) {
  for (int i = 0; i < 77; ++i) outcome(i);
  EXPECT_EQ(flows_.missing(), 0);
  EXPECT_EQ(report(), "");
}

TEST_F(LogFlowsTest, SixteenOfSeventySevenOutcomesThatAreNotThereAreReported) {
  for (int i = 0; i < 77; ++i) {
    if (i % 4 != 1 || i > 62) outcome(i);
  }
  EXPECT_EQ(flows_.missing(), 16);
  EXPECT_THAT(report(), HasSubstr("OUTCOME 16 of 77"));
}

TEST_F(LogFlowsTest, OrderDuplicatesAndRepairsMakeNoGap) {
  for (const int i : {2, 0, 3, 3, 1, 6}) outcome(i);
  outcome(4, 1, 0, "REPAIR.OUTCOME");
  outcome(5, 1, 0, "REPAIR.OUTCOME");
  EXPECT_EQ(report(), "");
}

TEST_F(LogFlowsTest, SessionsAreToldApart) {
  auto status = bus::testing::valid_message<node_status_t>(1);
  for (const std::int64_t session : {5, 6}) {
    status.session = session;
    for (status.sequence = 0; status.sequence < 3; ++status.sequence)
      flows_.count("STATUS.channel-server", bus::encoded(status));
    outcome(7, session);  // of two shards
  }
  EXPECT_EQ(flows_.missing(), 0);
  EXPECT_THAT(report(), HasSubstr("sessions: STATUS.channel-server 2\n"));
}

TEST_F(LogFlowsTest, TwoRunsOfTheSameSessionsAreToldApart) {
  for (int run = 0; run < 2; ++run) {
    for (int i = 0; i < 100; ++i) outcome(i, 1, 1'000'000 * i);
  }
  EXPECT_EQ(flows_.missing(), 0);
  EXPECT_THAT(report(), HasSubstr("several runs of the same sessions"));
}

TEST_F(LogFlowsTest, HostileNumbersNeitherOverflowNorGrow) {
  for (const std::int64_t sequence : {INT64_MIN, INT64_MAX, std::int64_t{0}, INT64_MIN, INT64_MAX})
    outcome(sequence, 1, sequence);
  EXPECT_GT(flows_.missing(), 0);
}

// The places of utime, session and sequence, of every message of a flow.
TEST_F(LogFlowsTest, EveryMessageOfAFlowIsCounted) {
  const auto missing_of = []<class Message>(const char* channel) {
    LogFlows flows;
    auto message = bus::testing::valid_message<Message>(1);
    message.session = 3;
    for (const std::int64_t sequence : {1, 4}) {
      message.sequence = sequence;
      flows.count(channel, bus::encoded(message));
    }
    return flows.missing();
  };
  EXPECT_EQ(missing_of.operator()<vehicle_state_t>("STATE.a"), 2);
  EXPECT_EQ(missing_of.operator()<modem_receive_t>("RECEIVE.a"), 2);
  EXPECT_EQ(missing_of.operator()<modem_receipt_t>("RECEIPT.a"), 2);
  EXPECT_EQ(missing_of.operator()<modem_event_t>("MODEM_EVENT.a"), 2);
  EXPECT_EQ(missing_of.operator()<packet_outcome_t>("OUTCOME"), 2);
  EXPECT_EQ(missing_of.operator()<link_table_t>("LINKS.a"), 2);
  EXPECT_EQ(missing_of.operator()<vehicle_sensors_t>("SENSORS.a"), 2);
  EXPECT_EQ(missing_of.operator()<vehicle_plan_t>("PLAN.a"), 2);
  EXPECT_EQ(missing_of.operator()<autopilot_status_t>("AUTOPILOT.a"), 2);
  EXPECT_EQ(missing_of.operator()<position_estimate_t>("ESTIMATE.a"), 2);
  EXPECT_EQ(missing_of.operator()<sim_clock_t>("CLOCK"), 2);
}

}  // namespace
}  // namespace halocline::clients
