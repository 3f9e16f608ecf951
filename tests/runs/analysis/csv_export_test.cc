// SPDX-License-Identifier: BSD-3-Clause
#include "runs/analysis/csv_export.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>

#include "core/check.h"
#include "tests/bus/logs/log_fixture.h"
#include "tests/support/file_size_limit.h"

namespace halocline::clients {
namespace {

using testing::state_at;
using testing::TemporaryLog;

class CsvExport : public ::testing::Test {
 protected:
  ~CsvExport() override { std::filesystem::remove_all(folder_); }

  ExportResult exported(const std::string& pattern = "") {
    LogReader log(file_.path());
    return export_csv(log, folder_, pattern);
  }
  std::vector<std::string> lines(const std::string& name) {
    std::ifstream in(folder_ + "/" + name);
    std::vector<std::string> out;
    for (std::string line; std::getline(in, line);) out.push_back(line);
    return out;
  }

  TemporaryLog file_;
  std::string folder_ = ::testing::TempDir() + "halocline-csv-" + std::to_string(getpid()) + "-" +
                        ::testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(CsvExport, OneFileForEachFamilyOneRowForEachMessage) {
  file_.add(100, "STATE.auv-1", state_at(100, 1.5));
  file_.add(200, "STATE.auv-2", state_at(200, 0.1));
  file_.add(200, "CLOCK", testing::clock_at(200));
  const ExportResult result = exported();
  EXPECT_EQ(result.rows_by_file.size(), 2u);
  const auto states = lines("state.csv");
  ASSERT_EQ(states.size(), 3u);
  EXPECT_EQ(states[0],
            "event,stamp_us,channel,utime,session,sequence,vehicle_id,position_ned_m_0,position_ned_m_1,"
            "position_ned_m_2,orientation_wxyz_0,orientation_wxyz_1,orientation_wxyz_2,orientation_wxyz_3,"
            "velocity_ned_mps_0,velocity_ned_mps_1,velocity_ned_mps_2,angular_velocity_body_radps_0,"
            "angular_velocity_body_radps_1,angular_velocity_body_radps_2");
  EXPECT_EQ(states[1], "0,100,STATE.auv-1,100,0,0,1,1.5,0,0,1,0,0,0,0,0,0,0,0,0");
  EXPECT_THAT(states[2], ::testing::HasSubstr(",0.1,"));
}

TEST_F(CsvExport, AFullDiskLeavesAllFilesOfTheExportBefore) {
  for (int i = 0; i < 200; ++i) file_.add(i, "STATE.auv-1", state_at(i, 0.1));
  file_.add(300, "CLOCK", testing::clock_at(300));
  exported();
  const auto states = lines("state.csv"), clocks = lines("clock.csv");
  {
    const halocline::testing::FileSizeLimit full_disk(4096);
    EXPECT_THROW(exported("STATE.*"), std::runtime_error);
  }
  EXPECT_EQ(lines("state.csv"), states);
  EXPECT_EQ(lines("clock.csv"), clocks);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 2);
}

TEST_F(CsvExport, ListsOfAMessageWithinAMessageHaveARowForEachElement) {
  link_reply_t reply{};
  reply.num_answers = 1;
  reply.answers.resize(1);
  link_paths_t& sound = reply.link_paths;
  sound.num_points = 3;
  sound.point_path = {0, 0, 1};
  sound.point_range_m = {0, 10, 0};
  sound.point_depth_m = {5, 6, 7.25};
  file_.add(100, "LINK_REPLY.monitor", reply);
  exported();
  const auto rows = lines("link_reply.csv");
  ASSERT_EQ(rows.size(), 4u);
  const auto column_of = [&](const std::string& name) {
    const auto at = rows[0].find(name);
    EXPECT_NE(at, std::string::npos);
    return std::count(rows[0].begin(), rows[0].begin() + static_cast<std::ptrdiff_t>(at), ',');
  };
  const auto cell = [&](std::size_t row, std::ptrdiff_t column) {
    std::istringstream line(rows[row]);
    std::string text;
    for (std::ptrdiff_t i = 0; i <= column; ++i) std::getline(line, text, ',');
    return text;
  };
  const auto depth = column_of("link_paths.point_depth_m");
  EXPECT_EQ(cell(1, depth), "5");
  EXPECT_EQ(cell(3, depth), "7.25");
  EXPECT_EQ(cell(3, column_of("link_paths.point_path")), "1");
  EXPECT_EQ(cell(2, column_of("answers.link.range_m")), "");  // that list has ended
}

TEST_F(CsvExport, LinkTableHasARowForEachPeer) {
  link_table_t table{};
  table.vehicle_id = 4;
  table.num_peers = 2;
  table.peers.resize(2);
  for (int i = 0; i < 2; ++i) table.peers[static_cast<std::size_t>(i)].receiver_id = 7 + i;
  file_.add(100, "LINKS.auv-4", table);
  EXPECT_EQ(exported().rows_by_file.begin()->second, 2);
  const auto rows = lines("links.csv");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_THAT(rows[0],
              ::testing::HasSubstr(
                  "vehicle_id,reach_m,num_out_of_reach,num_peers,peers.transmitter_id,peers.receiver_id"));
  EXPECT_THAT(rows[1], ::testing::HasSubstr(",4,0,0,2,0,7,"));
  EXPECT_THAT(rows[2], ::testing::HasSubstr(",4,0,0,2,0,8,"));
}

TEST_F(CsvExport, EmptyTableHasARowWithEmptyCells) {
  link_table_t table{};
  table.vehicle_id = 4;
  file_.add(100, "LINKS.auv-4", table);
  exported();
  const auto rows = lines("links.csv");
  ASSERT_EQ(rows.size(), 2u);
  constexpr std::size_t kFieldsOfALink = 36;
  EXPECT_THAT(rows[1], ::testing::EndsWith(",4,0,0,0" + std::string(kFieldsOfALink, ',')));
  EXPECT_EQ(std::count(rows[0].begin(), rows[0].end(), ','), std::count(rows[1].begin(), rows[1].end(), ','));
}

TEST_F(CsvExport, PayloadsAreHexadecimalAndTextsQuoted) {
  modem_send_t send{};
  send.source_id = 1;
  send.payload_size = 3;
  send.payload = {0x00, 0xff, 0x2c};
  file_.add(100, "SEND.auv-1", send);
  node_status_t status{};
  status.node_name = "node";
  status.status_text = "one, \"two\"";
  file_.add(100, "STATUS.node", status);
  exported();
  EXPECT_THAT(lines("send.csv").at(1), ::testing::EndsWith(",3,00ff2c"));
  EXPECT_THAT(lines("status.csv").at(1), ::testing::EndsWith(",\"one, \"\"two\"\"\""));
}

TEST_F(CsvExport, ForeignAndUndecodableEventsAreCountedNotFatal) {
  file_.add_bytes(1, "LCM_SELF_TEST", {1});
  file_.add_bytes(2, "STATE.Not A Name", {1});
  file_.add_bytes(3, "STATE.auv-1", {1, 2, 3});
  file_.add(4, "STATE.auv-1", testing::clock_at(4));
  file_.add(5, "STATE.auv-1", state_at(5));
  const ExportResult result = exported();
  EXPECT_EQ(result.foreign, 2);
  EXPECT_EQ(result.undecodable, 2);
  EXPECT_EQ(lines("state.csv").size(), 2u);
}

TEST_F(CsvExport, RepairedMessagesAreInTheFileOfTheirType) {
  file_.add(100, "REPAIR.STATE.auv-1", state_at(100, 1.5));
  file_.add(200, "REPAIR.CLOCK", testing::clock_at(200));
  file_.add(300, "STATE.auv-1", state_at(300, 2));
  EXPECT_EQ(exported().rows_by_file.size(), 2u);
  const auto states = lines("state.csv");
  ASSERT_EQ(states.size(), 3u);
  EXPECT_THAT(states[1], ::testing::StartsWith("0,100,REPAIR.STATE.auv-1,100,"));
  EXPECT_EQ(lines("clock.csv").size(), 2u);
}

TEST_F(CsvExport, PatternChoosesChannels) {
  file_.add(5, "STATE.auv-1", state_at(5));
  file_.add(5, "STATE.auv-2", state_at(5));
  EXPECT_EQ(exported("STATE\\.auv-2").rows_by_file.begin()->second, 1);
  EXPECT_THROW(exported("STATE.("), InvalidArgument);
}

}  // namespace
}  // namespace halocline::clients
