// SPDX-License-Identifier: BSD-3-Clause
#include "runs/analysis/log_statistics.h"

#include <sstream>

#include <gmock/gmock.h>

#include "tests/bus/logs/log_fixture.h"

namespace halocline::clients {
namespace {

using ::testing::HasSubstr;
using testing::TemporaryLog;

modem_receipt_t receipt(std::int64_t packet, std::int8_t result) {
  modem_receipt_t message{};
  message.send_session = 5;
  message.packet_sequence = packet;
  message.receipt_result = result;
  return message;
}

modem_receive_t packet(double travel_time_s) {
  modem_receive_t message{};
  message.source_id = 2;
  message.receiver_id = 1;
  message.stamped = 1;
  message.travel_time_s = travel_time_s;
  return message;
}

packet_outcome_t outcome(std::int8_t result) {
  packet_outcome_t message{};
  message.num_receivers = 1;
  message.source_id = 2;
  message.receiver_id = 1;
  message.outcome = result;
  return message;
}

LogStatistics statistics_of(TemporaryLog& file) {
  LogReader log(file.path());
  return statistics_of(log);
}

TEST(LogStatistics, CountsReceiptsOnceHoweverOftenTheyCame) {
  TemporaryLog file;
  file.add(1, "RECEIPT.auv-1", receipt(0, modem_receipt_t::ACCEPTED));
  file.add(2, "RECEIPT.auv-1", receipt(0, modem_receipt_t::ACCEPTED));
  file.add(3, "RECEIPT.auv-1", receipt(1, modem_receipt_t::REFUSED_BUSY));
  file.add(3, "RECEIPT.auv-2", receipt(1, modem_receipt_t::ACCEPTED));
  const LogStatistics statistics = statistics_of(file);
  EXPECT_EQ(statistics.packets_sent, 3);
  EXPECT_EQ(statistics.receipts[modem_receipt_t::ACCEPTED], 2);
  EXPECT_EQ(statistics.receipts[modem_receipt_t::REFUSED_BUSY], 1);
}

TEST(LogStatistics, DelaysHaveLeastMedianAndGreatest) {
  TemporaryLog file;
  for (const double delay : {0.5, 0.1, 0.2, 0.4}) file.add(1, "RECEIVE.auv-1", packet(delay));
  std::ostringstream text;
  print(text, statistics_of(file));
  EXPECT_THAT(text.str(), HasSubstr("0.100000 s least, 0.300000 s median, 0.500000 s greatest"));
}

TEST(LogStatistics, OutcomesAreCounted) {
  TemporaryLog file;
  file.add(1, "OUTCOME", outcome(packet_outcome_t::RECEIVED));
  file.add(1, "OUTCOME", outcome(packet_outcome_t::BELOW_CUTOFF));
  file.add(1, "OUTCOME", outcome(packet_outcome_t::BELOW_CUTOFF));
  std::ostringstream text;
  print(text, statistics_of(file));
  EXPECT_THAT(text.str(), HasSubstr("1 received, 2 below cutoff"));
}

TEST(LogStatistics, ForeignEventsAreCountedApart) {
  TemporaryLog file;
  file.add_bytes(10, "LCM_SELF_TEST", {1});
  file.add_bytes(20, "CLOCK", {1});
  file.add(30, "CLOCK", testing::clock_at(30));
  const LogStatistics statistics = statistics_of(file);
  EXPECT_EQ(statistics.events, 3);
  EXPECT_EQ(statistics.foreign, 1);
  EXPECT_EQ(statistics.undecodable, 1);
  EXPECT_EQ(statistics.first_stamp_us, 10);
  EXPECT_EQ(statistics.last_stamp_us, 30);
}

TEST(LogStatistics, UndecodableEventsAreCountedWithThePlaceOfTheFirst) {
  TemporaryLog file;
  file.add_bytes(10, "LCM_SELF_TEST", {1});
  file.add_bytes(20, "CLOCK", {1});
  const LogStatistics statistics = statistics_of(file);
  EXPECT_EQ(statistics.foreign_by_channel.at("LCM_SELF_TEST"), 1);
  EXPECT_EQ(statistics.undecodable_by_channel.at("CLOCK").first_at, file.path() + ", byte 42");
  EXPECT_THAT(to_json(statistics), HasSubstr("byte 42"));
}

TEST(LogStatistics, JsonHoldsTheSameNumbers) {
  TemporaryLog file;
  file.add(1, "RECEIVE.auv-1", packet(0.25));
  const std::string json = to_json(statistics_of(file));
  EXPECT_THAT(json, HasSubstr("\"packets_delivered\": 1"));
  EXPECT_THAT(json, HasSubstr("\"median\": 0.25"));
}

}  // namespace
}  // namespace halocline::clients
