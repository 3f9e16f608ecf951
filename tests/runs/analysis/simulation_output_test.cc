// SPDX-License-Identifier: BSD-3-Clause
// What of a log is simulation output: two logs of the same output give the same file, others do not.
#include "runs/analysis/simulation_output.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/check.h"
#include "tests/bus/logs/log_fixture.h"

namespace halocline::clients {
namespace {

using testing::state_at;
using testing::TemporaryLog;

modem_receipt_t receipt(std::int64_t packet, std::int64_t session, std::int64_t sequence) {
  modem_receipt_t m{};
  m.utime = 1'000'000;
  m.session = session;
  m.sequence = sequence;
  m.packet_sequence = packet;
  return m;
}

class SimulationOutput : public ::testing::Test {
 protected:
  ~SimulationOutput() override { std::filesystem::remove(out_); }

  std::string output_of(TemporaryLog& log) {
    LogReader reader(log.path());
    events_ = write_simulation_output(reader, out_);
    std::ifstream in(out_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  TemporaryLog one_{"-one"}, other_{"-other"};
  std::int64_t events_ = 0;
  std::string out_ = ::testing::TempDir() + "halocline-output-" + std::to_string(getpid()) + "-" +
                     ::testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(SimulationOutput, ForgetsWhichServerSaidItAsHisHowManieth) {
  one_.add(1'000'000, "RECEIPT.a", receipt(1, 7, 0));
  one_.add(1'000'000, "RECEIPT.b", receipt(2, 7, 1));
  other_.add(1'000'000, "RECEIPT.b", receipt(2, 8, 0));
  other_.add(1'000'000, "RECEIPT.a", receipt(1, 9, 0));
  EXPECT_EQ(output_of(one_), output_of(other_));
  EXPECT_EQ(events_, 2);
}

TEST_F(SimulationOutput, KeepsWhatWasSaidAndHowOften) {
  one_.add(1'000'000, "RECEIPT.a", receipt(1, 7, 0));
  other_.add(1'000'000, "RECEIPT.a", receipt(2, 7, 0));
  EXPECT_NE(output_of(one_), output_of(other_));
  TemporaryLog twice("-twice");
  twice.add(1'000'000, "RECEIPT.a", receipt(1, 7, 0));
  twice.add(1'000'000, "RECEIPT.a", receipt(1, 7, 1));
  EXPECT_NE(output_of(one_), output_of(twice));
}

TEST_F(SimulationOutput, HasTheScenarioWithoutItsPublisherAndTheTerrainAsItIs) {
  scenario_info_t scenario{};
  scenario.part_count = 1;
  terrain_tile_t terrain{};
  terrain.session = 5;
  for (TemporaryLog* log : {&one_, &other_}) {
    scenario.session = log == &one_ ? 7 : 8;
    scenario.sequence += 1;
    log->add(0, "TERRAIN", terrain);
    log->add(0, "SCENARIO", scenario);
  }
  EXPECT_EQ(output_of(one_), output_of(other_));
  EXPECT_EQ(events_, 2);
  TemporaryLog renamed("-renamed");
  scenario.scenario_name = "another";
  renamed.add(0, "TERRAIN", terrain);
  renamed.add(0, "SCENARIO", scenario);
  EXPECT_NE(output_of(one_), output_of(renamed));
}

TEST_F(SimulationOutput, KeepsTheStampOfEachMessage) {
  one_.add(1'000'000, "RECEIPT.a", receipt(1, 7, 0));
  other_.add(1'000'001, "RECEIPT.a", receipt(1, 7, 0));
  EXPECT_NE(output_of(one_), output_of(other_));
}

TEST_F(SimulationOutput, KeepsTheNumbersOfVehicles) {
  vehicle_state_t state = state_at(5);
  one_.add(5, "STATE.a", state);
  state.sequence = 1;
  other_.add(5, "STATE.a", state);
  EXPECT_NE(output_of(one_), output_of(other_));
}

TEST_F(SimulationOutput, LeavesOutWhatProgramsSayOfThemselvesAndToEachOther) {
  one_.add(5, "STATE.a", state_at(5));
  other_.add(5, "STATE.a", state_at(5));
  node_status_t status{};
  status.node_name = "channel-server-0";
  other_.add(6, "STATUS.channel-server-0", status);
  modem_reply_t answer{};
  other_.add(6, "MODEM_REPLY", answer);
  other_.add(6, "FOUND_PATHS.shard-0", found_paths_t{});
  other_.add(6, "TERRAIN_QUERY", terrain_query_t{});
  other_.add(6, "TERRAIN_REPLY.monitor", terrain_tile_t{});
  other_.add_bytes(6, "SOMEBODY_ELSES", {1, 2, 3});
  EXPECT_EQ(output_of(one_), output_of(other_));
  EXPECT_EQ(events_, 1);
}

TEST_F(SimulationOutput, RefusesALogInWallClockOrder) {
  one_.add(6, "STATE.a", state_at(6));
  one_.add(5, "STATE.a", state_at(5));
  EXPECT_THROW(output_of(one_), InvalidArgument);
}

TEST_F(SimulationOutput, RefusesAServersMessageThatDoesNotDecode) {
  one_.add_bytes(5, "OUTCOME", {1, 2, 3});
  EXPECT_THROW(output_of(one_), InvalidArgument);
}

}  // namespace
}  // namespace halocline::clients
