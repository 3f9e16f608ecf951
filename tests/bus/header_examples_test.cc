// SPDX-License-Identifier: BSD-3-Clause
// The examples in the comments of the headers of bus/, compiled and run (tests/docs/check_examples).
#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>

#include "bus/bus.h"
#include "bus/config/carried_files.h"
#include "bus/config/config.h"
#include "bus/lockstep/sequencer.h"
#include "bus/numbered_publisher.h"
#include "bus/recovery/crash_journal.h"
#include "bus/runtime/node.h"
#include "bus/runtime/thread_pool.h"
#include "core/files/file_path.h"
#include "core/sim_time.h"
#include "tests/bus/messages_for_tests.h"
#include "tests/support/working_folder.h"

namespace halocline::bus {
namespace {

using ::testing::ElementsAre;

TEST(HeaderExamples, Bus) {
  lcm::LCM lcm("memq://");
  const std::int64_t session = 7;
  const auto outcome = testing::valid_message<packet_outcome_t>(1);
  std::vector<std::string> received_of, channels_published_on;
  Bus recorder(lcm, {"recorder", session});
  recorder.subscribe_to_all([&](std::string_view channel, const void*, std::size_t) {
    channels_published_on.emplace_back(channel);
  });
  Bus bus(lcm, {"channel-server", session});
  bus.subscribe<vehicle_state_t>(channels::kState, [&](std::string_view vehicle, const vehicle_state_t& s) {
    received_of.push_back(std::string(vehicle) + " " + std::to_string(s.utime));
  });
  bus.publish(channels::kOutcome, outcome);
  auto state = testing::valid_message<vehicle_state_t>(1);
  state.utime = 5;
  bus.publish(channels::kState.of("auv-1"), state);
  while (lcm.handleTimeout(0) > 0) {
  }
  EXPECT_THAT(channels_published_on, ElementsAre(channels::kOutcome, channels::kState.of("auv-1")));
  EXPECT_THAT(received_of, ElementsAre("auv-1 5"));
}

struct MyConfig {
  double wind_mps = 0;
};
void visit(ConfigVisitor& v, MyConfig& c) {
  v.number("wind_mps", c.wind_mps, {0, 60, "m/s", "10 m above the sea"});
}

TEST(HeaderExamples, Config) {
  MyConfig config;
  ConfigFile file = ConfigFile::parse("wind_mps = 12", "test.toml");
  file.read([&](ConfigVisitor& v) { visit(v, config); });
  file.check(/*whole_file=*/true);
  EXPECT_EQ(config.wind_mps, 12);
}

TEST(HeaderExamples, CarriedFiles) {
  FilePath modem;
  ConfigFile file = ConfigFile::parse(R"(
    modem = "modem.toml"
    [[file]]
    name = "modem.toml"
    xxh3 = "a9ca6625fbec8fdf"
    lines = ["source_level_db = 181.0", ""]
  )",
                                      "test.toml");
  file.read([&](ConfigVisitor& v) { v.file("modem", modem, FileNames::kFiles, ""); });
  file.check(/*whole_file=*/true);
  std::ifstream in(modem.place());
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), "source_level_db = 181.0\n");
}

TEST(HeaderExamples, Sequencer) {
  using conductor::Sequencer;
  const SimTime end = SimTime::from_seconds(2.0);
  lockstep_join_t join{};
  join.participant_name = "clock";
  std::vector<double> turns_at_s;
  const auto take = [&](const lockstep_turn_t& turn) {
    turns_at_s.push_back(SimTime::from_nanoseconds(turn.instant_ns).seconds());
    lockstep_result_t result{};
    result.participant_name = "clock";
    result.num_steps = 1;
    result.reached_ns = turn.instant_ns;
    result.next_due_ns = turn.instant_ns + 1'000'000'000;
    return result;
  };
  Sequencer sequencer([](const lockstep_message_t&) {});
  sequencer.admit(join);
  while (sequencer.next_instant() <= end) {
    sequencer.begin_instant(sequencer.next_instant());
    while (sequencer.begin_round()) {
      std::vector<lockstep_result_t> results;
      for (const std::string& name : sequencer.round()) results.push_back(take(sequencer.turn_of(name)));
      sequencer.complete(results);
    }
  }
  EXPECT_THAT(turns_at_s, ElementsAre(0, 1, 2));
}

// The members that a node's example uses.
class NodeExamples : public ::testing::Test {
 protected:
  NodeExamples() {
    receiver_.subscribe<vehicle_state_t>(channels::kState,
                                         [this](std::string_view, const vehicle_state_t& s) {
                                           published_.emplace_back(s.session, s.sequence);
                                         });
  }
  Bus& bus() { return bus_; }
  std::vector<std::pair<std::int64_t, std::int64_t>> published() {
    while (lcm_.handleTimeout(0) > 0) {
    }
    return std::exchange(published_, {});
  }

 private:
  const halocline::testing::TemporaryFolder folder_;
  lcm::LCM lcm_{"memq://"};
  Bus bus_{lcm_, {"vehicle-sim", 77}};
  Bus receiver_{lcm_, {"receiver", 1}};
  std::vector<std::pair<std::int64_t, std::int64_t>> published_;
};

TEST_F(NodeExamples, NumberedPublisher) {
  const auto state = testing::valid_message<vehicle_state_t>(1);
  NumberedPublisher publisher(bus());
  publisher.publish(channels::kState.of("auv-1"), state);
  publisher.publish(channels::kState.of("auv-1"), state);
  EXPECT_THAT(published(), ElementsAre(std::pair(77, 0), std::pair(77, 1)));
}

TEST_F(NodeExamples, CrashJournal) {
  using Inbox = std::vector<std::string>;
  const std::string name = "auv-1";
  const auto state = testing::valid_message<vehicle_state_t>(1);
  CrashJournal::Rule rule;
  rule.path = "journal";
  rule.kept = SimDuration::from_seconds(60.0);
  rule.is_input = [](std::string_view) { return true; };
  for (const int incarnation : {1, 2}) {
    std::vector<std::pair<SimTime, Inbox>> history;
    std::vector<SimTime> done_again;
    const auto take_inbox = [] { return Inbox(); };
    const auto forget_all = [&] { history.clear(); };
    const auto run_to = [&](SimTime at, const Inbox&) { done_again.push_back(at); };
    Now now;
    now.sim = SimTime::from_seconds(1.0 * incarnation);
    NumberedPublisher publisher(bus());

    CrashJournal journal(bus(), publisher);
    journal.open(rule);
    journal.replay_inputs([&](SimTime at) { history.push_back({at, take_inbox()}); });

    if (!history.empty() && !journal.resume(now.sim)) forget_all();
    for (const auto& [at, inbox] : history) {
      journal.redo_step(at);
      run_to(at, inbox);
    }

    journal.write_inputs(now.sim);
    // The node acts.
    journal.end_recovery();
    journal.publish_once(channels::kState.of(name), state, std::to_string(state.utime));

    // The second finds the first one's step, and does not publish again what that published.
    EXPECT_EQ(done_again.size(), incarnation == 1 ? 0u : 1u);
    EXPECT_EQ(published().size(), incarnation == 1 ? 1u : 0u);
  }
}

TEST(HeaderExamples, ThreadPool) {
  const std::vector<int> links{1, 2, 3};
  std::vector<int> rows(links.size());
  const auto row_of = [](int link) { return 10 * link; };
  ThreadPool pool(2);
  pool.for_each(links.size(), [&](std::size_t i) { rows[i] = row_of(links[i]); });
  EXPECT_THAT(rows, ElementsAre(10, 20, 30));
}

}  // namespace
}  // namespace halocline::bus
