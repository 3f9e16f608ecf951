// SPDX-License-Identifier: BSD-3-Clause
#include "runs/analysis/outcome_summary.h"

#include <numeric>
#include <sstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "core/check.h"
#include "core/csv_table.h"
#include "tests/bus/logs/log_fixture.h"

namespace halocline::clients {
namespace {

using testing::TemporaryLog;

constexpr std::int64_t kMinute = 60'000'000;
constexpr auto kReceived = static_cast<std::size_t>(packet_outcome_t::RECEIVED);
constexpr auto kCollided = static_cast<std::size_t>(packet_outcome_t::COLLIDED);

packet_outcome_t outcome(std::int32_t from, std::int32_t to, std::int64_t sequence,
                         std::int64_t departure_utime, std::int8_t result) {
  packet_outcome_t o{};
  o.num_receivers = 1;
  o.utime = departure_utime + 1'500'000;
  o.source_id = from;
  o.receiver_id = to;
  o.packet_sequence = sequence;
  o.departure_utime = departure_utime;
  o.outcome = result;
  o.strongest_path_doppler_factor = 1;
  return o;
}

class OutcomeSummaryTest : public ::testing::Test {
 protected:
  void add(const packet_outcome_t& o) { file_.add(o.utime, "OUTCOME", o); }
  OutcomeSummary summary(std::int64_t window_us = kMinute) {
    LogReader log(file_.path());
    return summary_of(log, window_us);
  }
  TemporaryLog file_;
};

TEST_F(OutcomeSummaryTest, ReceiversOutOfReachCountOneByOneButAreNoPair) {
  packet_outcome_t others = outcome(1, 0, 0, 0, packet_outcome_t::OUT_OF_REACH);
  others.num_receivers = 97;
  add(others);
  add(others);  // a repetition
  add(outcome(1, 2, 0, 0, packet_outcome_t::RECEIVED));
  const OutcomeSummary sums = summary();
  EXPECT_EQ(sums.total()[packet_outcome_t::OUT_OF_REACH], 97);
  EXPECT_EQ(sum(sums.total()), 98);
  EXPECT_EQ(sum(sums.by_window().at(0)), 98);
  EXPECT_EQ(sums.by_pair().size(), 1u);
  EXPECT_EQ(sums.by_propagation()[packet_outcome_t::STRAIGHT], 1);
  EXPECT_EQ(sums.name(0), "several");
}

TEST_F(OutcomeSummaryTest, CountsByOutcomePairAndWindowOfDepartureAgree) {
  add(outcome(1, 2, 0, 0, packet_outcome_t::RECEIVED));
  add(outcome(1, 3, 0, 0, packet_outcome_t::COLLIDED));
  add(outcome(2, 3, 7, kMinute - 1, packet_outcome_t::COLLIDED));
  add(outcome(1, 2, 1, kMinute, packet_outcome_t::RECEIVED));
  const OutcomeSummary sums = summary();
  EXPECT_EQ(sums.total()[kReceived], 2);
  EXPECT_EQ(sums.total()[kCollided], 2);
  EXPECT_EQ((sums.by_pair().at({1, 2})[kReceived]), 2);
  EXPECT_EQ((sums.by_pair().at({1, 3})[kCollided]), 1);
  EXPECT_EQ((sums.by_pair().at({2, 3})[kCollided]), 1);
  EXPECT_EQ(sums.by_window().at(0)[kReceived], 1);
  EXPECT_EQ(sums.by_window().at(0)[kCollided], 2);
  EXPECT_EQ(sums.by_window().at(kMinute)[kReceived], 1);
}

TEST_F(OutcomeSummaryTest, ARepeatedOutcomeCountsOnce) {
  add(outcome(1, 2, 0, 0, packet_outcome_t::RECEIVED));
  add(outcome(1, 2, 0, 0, packet_outcome_t::RECEIVED));
  const OutcomeSummary sums = summary();
  EXPECT_EQ(sums.total()[kReceived], 1);
  EXPECT_EQ(sums.repeated(), 1);
}

TEST_F(OutcomeSummaryTest, VehiclesGoByTheNamesOfTheirStates) {
  file_.add(0, "STATE.auv-1", testing::state_at(0));
  add(outcome(1, 9, 0, 0, packet_outcome_t::RECEIVED));
  const OutcomeSummary sums = summary();
  EXPECT_EQ(sums.name(1), "auv-1");
  EXPECT_EQ(sums.name(9), "9");
}

TEST_F(OutcomeSummaryTest, TimesBeforeZeroFallIntoWindowsOfTheirOwn) {
  add(outcome(1, 2, 0, -1, packet_outcome_t::RECEIVED));
  EXPECT_EQ(summary().by_window().begin()->first, -kMinute);
}

TEST_F(OutcomeSummaryTest, AWindowOfNothingIsRefused) { EXPECT_THROW(OutcomeSummary(0), InvalidArgument); }

TEST_F(OutcomeSummaryTest, JsonAndCsvHoldTheSameCounts) {
  add(outcome(1, 2, 0, 0, packet_outcome_t::RECEIVED));
  add(outcome(1, 3, 0, 0, packet_outcome_t::COLLIDED));
  const OutcomeSummary sums = summary();
  const auto json = nlohmann::json::parse(to_json(sums));
  EXPECT_EQ(json["outcomes"], 2);
  EXPECT_EQ(json["by_outcome"]["received"], 1);
  EXPECT_EQ(json["pairs"][1]["by_outcome"]["collided"], 1);
  std::stringstream csv;
  print_csv(csv, sums);
  EXPECT_EQ(csv.str(), "from,to,outcome,packets\n1,2,received,1\n1,3,collided,1\n");
}

TEST_F(OutcomeSummaryTest, EachOutcomeIsARowWithTheCollidersThatDecidedIt) {
  packet_outcome_t lost = outcome(1, 2, 5, 0, packet_outcome_t::COLLIDED);
  packet_name_t other{};
  other.source_id = 3;
  other.packet_sequence = 8;
  lost.num_colliders = 1;
  lost.colliders = {other};
  lost.interference_level_db = 91.5;
  lost.packet_kind = modem_receive_t::MINI_PACKET;
  lost.rate_number = 4;
  lost.duration_s = 0.875;
  lost.num_frames = 3;
  lost.num_frames_good = 2;
  add(lost);
  std::stringstream csv;
  print_outcomes_csv(csv, summary());
  std::vector<std::string> errors;
  const CsvTable table = read_csv(csv, errors);
  ASSERT_TRUE(errors.empty());
  ASSERT_EQ(table.rows.size(), 1u);
  EXPECT_EQ(table.rows[0].cells[*table.column("colliders")], "3:8");
  for (const auto& [column, value] : {std::pair("interference_level_db", "91.5"),
                                      {"packet_kind", "mini_packet"},
                                      {"rate_number", "4"},
                                      {"duration_s", "0.875"},
                                      {"num_frames", "3"},
                                      {"num_frames_good", "2"}})
    EXPECT_EQ(table.rows[0].cells[*table.column(column)], value) << column;
}

TEST_F(OutcomeSummaryTest, ThePrintedTableNamesEveryOutcomeThatOccurred) {
  add(outcome(1, 2, 0, 0, packet_outcome_t::RECEIVED));
  add(outcome(1, 3, 0, 0, packet_outcome_t::HALF_DUPLEX));
  std::ostringstream text;
  print(text, summary(), "");
  EXPECT_THAT(text.str(),
              ::testing::AllOf(::testing::HasSubstr("2 outcomes"), ::testing::HasSubstr("50.0 %"),
                               ::testing::HasSubstr("half duplex"), ::testing::HasSubstr("1 -> 3")));
}

TEST_F(OutcomeSummaryTest, TextJsonAndRowsNameWhatThePathsWereComputedWith) {
  packet_outcome_t rays = outcome(1, 2, 0, 0, packet_outcome_t::RECEIVED), straight = rays;
  rays.propagation_used = packet_outcome_t::RAYS;
  straight.receiver_id = 3;
  straight.propagation_used = packet_outcome_t::STRAIGHT_WITHOUT_BOTTOM;
  add(rays);
  add(straight);
  const OutcomeSummary sums = summary();
  std::ostringstream text;
  print(text, sums, "");
  EXPECT_THAT(text.str(), ::testing::AllOf(::testing::HasSubstr("paths: rays  "),
                                           ::testing::HasSubstr("paths: straight without bottom")));
  const auto json = nlohmann::json::parse(to_json(sums));
  EXPECT_EQ(json["by_propagation"]["rays"], 1);
  EXPECT_EQ(json["by_propagation"]["straight without bottom"], 1);
  std::stringstream csv;
  print_outcomes_csv(csv, sums);
  std::vector<std::string> errors;
  const CsvTable table = read_csv(csv, errors);
  EXPECT_EQ(table.rows.at(1).cells[*table.column("propagation")], "straight without bottom");
}

TEST_F(OutcomeSummaryTest, ThePlotHoldsABarAnOutcomeAndItsCourseOverTheWindows) {
  add(outcome(1, 2, 0, 0, packet_outcome_t::RECEIVED));
  add(outcome(1, 3, 0, 0, packet_outcome_t::COLLIDED));
  add(outcome(1, 3, 1, kMinute, packet_outcome_t::COLLIDED));
  const Plot plot = outcome_plot(summary(), "a run");
  ASSERT_EQ(plot.charts.size(), 2u);
  EXPECT_THAT(plot.charts[0].categories, ::testing::ElementsAre("received", "collided"));
  EXPECT_THAT(plot.charts[0].series.at(0).y, ::testing::ElementsAre(1, 2));
  ASSERT_EQ(plot.charts[1].series.size(), 2u);
  EXPECT_THAT(plot.charts[1].series[1].x, ::testing::ElementsAre(0, 60));
  EXPECT_THAT(plot.charts[1].series[1].y, ::testing::ElementsAre(1, 1));
}

TEST_F(OutcomeSummaryTest, ALogWithoutOutcomesHasNone) {
  file_.add(0, "CLOCK", testing::clock_at(0));
  std::ostringstream text;
  print(text, summary(), "");
  EXPECT_THAT(text.str(), ::testing::HasSubstr("0 outcomes"));
}

}  // namespace
}  // namespace halocline::clients
