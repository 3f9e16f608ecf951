// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/calibration/trial_data.h"

#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "core/check.h"

namespace halocline::clients {
namespace {

std::vector<TrialRow> read(const std::string& text) {
  std::istringstream in(text);
  return read_trial_csv(in, "days.csv");
}

std::string error_of(const std::string& text) {
  try {
    read(text);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "";
}

TEST(TrialData, PacketsAndLevelsAreRead) {
  const auto rows = read("time,from,to,sent,received,snr_db\n10,a,b,20,7,\n20,a,\"5,0,10\",,,-3.5\n");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].sent, 20);
  EXPECT_EQ(rows[0].received, 7);
  EXPECT_FALSE(rows[0].snr_db.has_value());
  EXPECT_EQ(rows[1].to, "5,0,10");
  EXPECT_EQ(rows[1].snr_db, -3.5);
}

TEST(TrialData, DatesCountFromTheFirst) {
  const auto rows =
      read("time,from,to,sent,received\n2026-05-03T15:00:00+01:00,a,b,1,1\n2026-05-03 14:00:30.5Z,a,b,1,1\n");
  EXPECT_EQ(rows[0].time_s, 0);
  EXPECT_EQ(rows[1].time_s, 30.5);
}

TEST(TrialData, SecondsOfADate) {
  EXPECT_EQ(seconds_of_date("1970-01-02"), 86'400);
  EXPECT_EQ(seconds_of_date("2000-03-01T00:00:00Z"), 951'868'800);
  for (const char* text : {"", "2026", "2026-13-01", "2026-02-30", "2026-05-03T", "2026-05-03T14", "x"})
    EXPECT_FALSE(seconds_of_date(text).has_value()) << text;
}

TEST(TrialData, BadRowsAreNamedByFileLineAndColumn) {
  const std::string error = error_of("time,from,to,sent,received\n1,a,b,3,4\nsoon,a,b,1,1\n3,a,b,x,1\n");
  EXPECT_NE(error.find("days.csv:2:5: '4': more were received than sent"), std::string::npos) << error;
  EXPECT_NE(error.find("days.csv:3:1: 'soon'"), std::string::npos) << error;
  EXPECT_NE(error.find("days.csv:4:4: 'x'"), std::string::npos) << error;
}

TEST(TrialData, OtherFaultsAreRefused) {
  EXPECT_NE(error_of("time,from,to\n1,a,b\n"), "");
  EXPECT_NE(error_of("from,to,sent,received\na,b,1,1\n"), "");
  EXPECT_NE(error_of("time,from,to,sent\n1,a,b,1\n"), "");
  EXPECT_NE(error_of("time,from,to,sent,received\n1,a,a,1,1\n"), "");
  EXPECT_NE(error_of("time,from,to,sent,received\n1,a,b,,\n"), "");
  EXPECT_NE(error_of("time,from,to,sent,received\n"), "");
  EXPECT_NE(error_of("time,from,to,sent,received\n1,a,b,1\n"), "");
  EXPECT_NE(error_of("time,from,to,sent,received\n1,a,b,1,1\n2026-05-03,a,b,1,1\n"), "");
}

TEST(TrialData, FilesOfSpreadsheetsAreRead) {
  const auto rows = read("\xEF\xBB\xBFtime,from,to,sent,received\r\n20,a,b,3,1\r\n10,a,b,2,2\r\n");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[1].received, 2);
  const std::string error = error_of("time;from;to;sent;received\n1;a;b;3;1\n");
  EXPECT_NE(error.find("days.csv:1:1: cells are parted by semicolons"), std::string::npos) << error;
  EXPECT_EQ(error.find('\n'), std::string::npos) << error;
}

TEST(TrialData, EndsThatTheScenarioLacksAreNamedByLine) {
  std::istringstream in("time,from,to,sent,received\n1,a,b,1,1\n2,a,buoy,1,1\n");
  try {
    read_trial_csv(in, "days.csv", [](const std::string& end) {
      return end == "buoy" ? std::string("no such vehicle") : std::string();
    });
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_STREQ(error.what(), "days.csv:3:3: 'buoy': no such vehicle");
  }
}

TEST(TrialData, BinsSumPacketsAndAverageLevels) {
  const auto pairs =
      pairs_of({{.time_s = 10, .from = "a", .to = "b", .sent = 5, .received = 2, .level_db = 90},
                {.time_s = 20, .from = "a", .to = "b", .sent = 5, .received = 1, .level_db = 94},
                {.time_s = 110, .from = "a", .to = "b", .sent = 1, .received = 1},
                {.time_s = 5, .from = "b", .to = "a", .sent = 1, .received = 0}},
               100);
  ASSERT_EQ(pairs.size(), 2U);
  ASSERT_EQ(pairs[0].bins.size(), 2U);
  EXPECT_EQ(pairs[0].bins[0].sent, 10);
  EXPECT_EQ(pairs[0].bins[0].received, 3);
  EXPECT_EQ(pairs[0].bins[0].levels, 2U);
  EXPECT_DOUBLE_EQ(pairs[0].bins[0].level_db, 92);
  EXPECT_EQ(pairs[0].sent(), 11);
  EXPECT_EQ(pairs[1].received(), 0);
}

}  // namespace
}  // namespace halocline::clients
