// SPDX-License-Identifier: BSD-3-Clause
// What a whole run promises: the same bytes each time, a log that replays to the same answers, a sound end.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "bus/logs/log_reader.h"
#include "bus/runtime/node.h"
#include "bus/transport/node_identity.h"
#include "clients/onboard/traffic/relay_packet.h"
#include "core/sim_time.h"
#include "simulation/composition.h"
#include "simulation/log_estimate.h"
#include "tests/integration/embedded_fixture.h"

namespace halocline::clients {
namespace {

class EmbeddedRunTest : public testing::EmbeddedTest {
 public:
  using testing::EmbeddedTest::messages_in;

 protected:
  ScenarioConfig harbour() { return load("harbour", {"scenario.duration_s=25"}); }
};

// The bytes of all events on a family's channels, stamps and channels included, without the log's numbering.
std::string bytes_of_families(const std::string& path, const std::vector<std::string>& families) {
  std::string all;
  LogReader log(path);
  for (LoggedEvent event; log.next(event);) {
    const std::string family(family_of(event.channel));
    if (std::find(families.begin(), families.end(), family) == families.end()) continue;
    all += std::to_string(event.stamp_us) + event.channel + std::string(event.data.begin(), event.data.end());
  }
  return all;
}

// The messages of a family as a set: channel and bytes without session and sequence number.
template <class Message>
void add_unnumbered(const std::string& path, std::multiset<std::string>& all) {
  for (auto& [channel, message] : EmbeddedRunTest::messages_in<Message>(path)) {
    message.session = message.sequence = 0;
    std::string bytes(static_cast<std::size_t>(message.getEncodedSize()), '\0');
    message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    all.insert(channel + bytes);
  }
}

// Everything that channel servers publish.
std::multiset<std::string> published(const std::string& path) {
  std::multiset<std::string> all;
  add_unnumbered<link_table_t>(path, all);
  add_unnumbered<packet_outcome_t>(path, all);
  add_unnumbered<modem_receipt_t>(path, all);
  add_unnumbered<modem_receive_t>(path, all);
  add_unnumbered<environment_t>(path, all);
  return all;
}

TEST_F(EmbeddedRunTest, TwoRunsWriteTheSameBytes) {
  const std::string first = bytes_of(run(harbour(), "first"));
  EXPECT_GT(first.size(), 100'000u);
  EXPECT_TRUE(first == bytes_of(run(harbour(), "second")));
}

// Where hours differ, the seed draws them; of a still sea it draws fading alone.
TEST_F(EmbeddedRunTest, AnotherSeedIsAnotherSessionAndTheSameWater) {
  std::vector<std::string> overrides = still_sea();
  overrides.emplace_back("scenario.duration_s=25");
  ScenarioConfig config = load("harbour", overrides);
  const std::string one = run(config, "one");
  config.scenario.seed = 99;
  const std::string other = run(config, "other");
  const auto a = messages_in<link_table_t>(one), b = messages_in<link_table_t>(other);
  ASSERT_EQ(a.size(), b.size());
  EXPECT_NE(a.back().second.session, b.back().second.session);
  EXPECT_EQ(a.back().second.peers[0].received_level_db, b.back().second.peers[0].received_level_db);
}

// The receiver synchronises on one of the paths: on the first significant one, whose travel time is stated,
// where a stronger guard interval begins, within the delay spread, or at a fainter path just before, whose
// power the interval holds as well.
TEST_F(EmbeddedRunTest, PacketsArriveWithTheirDelay) {
  const ScenarioConfig config = harbour();
  const std::string log = run(config, "log");
  const auto packets = messages_in<modem_receive_t>(log);
  ASSERT_FALSE(packets.empty());
  std::map<std::pair<std::int64_t, std::int64_t>, double> durations;
  for (const auto& [channel, receipt] : messages_in<modem_receipt_t>(log)) {
    durations[{receipt.send_session, receipt.packet_sequence}] = receipt.duration_s;
  }
  std::map<std::tuple<std::int64_t, std::int64_t, std::int32_t>, double> spreads;
  for (const auto& [channel, outcome] : messages_in<packet_outcome_t>(log)) {
    spreads[{outcome.send_session, outcome.packet_sequence, outcome.receiver_id}] = outcome.delay_spread_s;
  }
  constexpr double kRoundedS = 2e-6;  // utime is
  std::size_t at_first = 0;           // or just before
  for (const auto& [channel, packet] : packets) {
    EXPECT_GT(packet.travel_time_s, 0.02);  // the nearest two are 50 m apart
    const double received_s =
        durations.at({packet.send_session, packet.packet_sequence}) / packet.strongest_path_doppler_factor;
    const double locked_s = static_cast<double>(packet.utime - packet.departure_utime) * 1e-6 - received_s;
    EXPECT_GT(locked_s,
              packet.travel_time_s - kRoundedS - config.channel_server.modem.modem.guard_time.seconds());
    EXPECT_LT(locked_s, packet.travel_time_s + kRoundedS +
                            spreads.at({packet.send_session, packet.packet_sequence, packet.receiver_id}));
    at_first += locked_s < packet.travel_time_s + kRoundedS ? 1 : 0;
  }
  EXPECT_GT(at_first, packets.size() * 9 / 10);
}

TEST_F(EmbeddedRunTest, EveryAcceptedPacketHasAnOutcomeAtEveryOtherVehicle) {
  const ScenarioConfig config = harbour();
  const std::string log = run(config, "log");
  std::int64_t ended = 0;
  for (const auto& [channel, receipt] : messages_in<modem_receipt_t>(log)) {
    const double end_s = static_cast<double>(receipt.start_utime) * 1e-6 + receipt.duration_s + 2;
    if (receipt.receipt_result == modem_receipt_t::ACCEPTED && end_s < 25) ++ended;
  }
  ASSERT_GT(ended, 3);
  const auto outcomes = static_cast<std::int64_t>(messages_in<packet_outcome_t>(log).size());
  EXPECT_GE(outcomes, ended * 4);  // five vehicles; packets of the last two seconds may have theirs too
}

TEST_F(EmbeddedRunTest, ReplayGivesTheAnswersOfTheRun) {
  const std::string original = run(harbour(), "original");
  const std::string again = replay(harbour(), original, "again");
  const std::vector<std::string> answers{"LINKS", "OUTCOME", "RECEIPT", "RECEIVE", "ENVIRONMENT"};
  const std::string expected = bytes_of_families(original, answers);
  EXPECT_GT(expected.size(), 10'000u);
  EXPECT_TRUE(expected == bytes_of_families(again, answers));
}

TEST_F(EmbeddedRunTest, LinksGoAlongRaysOverTheTerrain) {
  const auto tables = messages_in<link_table_t>(run(harbour(), "log"));
  int by_rays = 0, rows = 0;
  for (const auto& [channel, table] : tables) {
    for (const link_t& row : table.peers) {
      ++rows;
      by_rays += row.propagation_used == link_t::USED_RAYS ? 1 : 0;
    }
  }
  EXPECT_GT(rows, 400);
  EXPECT_EQ(by_rays, rows);
}

// Lockstep waits for the bottom, so no table of a run goes straight, not even the first.
TEST_F(EmbeddedRunTest, TheFirstTableGoesAlongRays) {
  const auto tables = messages_in<link_table_t>(run(load("seamount", {"scenario.duration_s=1"}), "log"));
  ASSERT_EQ(tables.size(), 3u);
  for (const auto& [channel, table] : tables) {
    EXPECT_EQ(table.utime, 1'000'000);
    ASSERT_EQ(table.peers.size(), 2u);
    for (const link_t& row : table.peers) EXPECT_EQ(row.propagation_used, link_t::USED_RAYS) << channel;
  }
}

// Without start_s the first packet leaves with the first state, of which the server may not yet know.
TEST_F(EmbeddedRunTest, ThePacketOfTheFirstInstantIsTransmitted) {
  const std::string log =
      run(load("harbour", {"scenario.duration_s=5", "vehicle.0.traffic.start_s=0"}), "log");
  const auto receipts = messages_in<modem_receipt_t>(log);
  ASSERT_FALSE(receipts.empty());
  EXPECT_EQ(receipts[0].first, "RECEIPT.quay");
  EXPECT_EQ(receipts[0].second.receipt_result, modem_receipt_t::ACCEPTED);
  EXPECT_EQ(receipts[0].second.start_utime, 50'000);  // channel_server.state_lag_s
  EXPECT_FALSE(messages_in<modem_receive_t>(log).empty());
}

// The numbers of the explorer's reports that arrived at the boat.
std::set<int> reports_at_the_boat(const std::string& log) {
  std::set<int> numbers;
  for (const auto& [channel, packet] : EmbeddedRunTest::messages_in<modem_receive_t>(log)) {
    const auto report = decode_relay_packet(packet.payload);
    if (channel == "RECEIVE.boat" && report && report->origin == 4) numbers.insert(report->number);
  }
  return numbers;
}

TEST_F(EmbeddedRunTest, ReportsGoRoundAnIslandByRelaysAlone) {
  EXPECT_GT(reports_at_the_boat(run(load("relay", still_sea()), "log")).size(), 15u);  // of 20
  const auto alone = load("relay", {"vehicle.1.traffic.relay=false", "vehicle.2.traffic.relay=false"});
  EXPECT_TRUE(reports_at_the_boat(run(alone, "alone")).empty());
}

TEST_F(EmbeddedRunTest, TheLogIsAsLargeAsEstimated) {
  for (const char* name : {"harbour", "seamount", "navigation", "ranging", "relay"}) {
    const ScenarioConfig config = load(name, {"scenario.duration_s=60"});
    const auto bytes = static_cast<double>(bytes_of(run(config, name)).size());
    EXPECT_NEAR(estimated_log_bytes(config) / bytes, 1, 0.15) << name;
  }
}

TEST_F(EmbeddedRunTest, TwoThreadsWriteTheSameBytesAsOne) {
  ScenarioConfig config = harbour();
  const std::string one = bytes_of(run(config, "one"));
  config.channel_server.rules.threads = 2;
  EXPECT_TRUE(one == bytes_of(run(config, "two")));
}

TEST_F(EmbeddedRunTest, ShardsAndBlocksOnThreadsWriteTheSameBytesAsInTurn) {
  for (const char* scenario : {"harbour", "ranging"}) {
    ScenarioConfig config =
        load(scenario, {"scenario.duration_s=25", "channel_server.shards=3", "vehicle_sim.blocks=3"});
    const std::string in_turn = bytes_of(run(config, "in-turn"));
    config.channel_server.rules.threads = 3;
    EXPECT_TRUE(in_turn == bytes_of(run(config, "on-threads"))) << scenario;
  }
}

TEST_F(EmbeddedRunTest, ShardsTogetherPublishWhatOneServerPublishes) {
  const std::vector<std::string> rays{"scenario.duration_s=25"};
  const std::vector<std::string> straight{"scenario.duration_s=25", "propagation.model=\"straight\""};
  for (auto [scenario, settings] :
       {std::pair{"harbour", rays}, {"ranging", rays}, {"harbour", straight}}) {  // the second pings
    const auto one = published(run(load(scenario, settings), "one"));
    EXPECT_GT(one.size(), 100u);
    for (const char* shards : {"channel_server.shards=2", "channel_server.shards=3"}) {
      settings.emplace_back(shards);
      EXPECT_TRUE(published(run(load(scenario, settings), "many")) == one) << scenario << ' ' << shards;
    }
  }
}

// Piloted by their sensors the vehicles move alike whichever states are published.
TEST_F(EmbeddedRunTest, StatesByDeadReckoningMoveTheLinksByNoMoreThanTheBound) {
  std::vector<std::string> settings{"scenario.duration_s=120", "propagation.model=\"straight\""};
  for (const char* piloted : {"1", "2", "4"})
    settings.push_back("vehicle." + std::string(piloted) + ".mission.navigate_by=\"sensors\"");
  const std::string all = run(load("harbour", settings), "all");
  const double bound_m = 0.3;
  settings.insert(settings.end(), {"vehicle_sim.state_deviation_m=0.3", "vehicle_sim.state_deviation_deg=180",
                                   "vehicle_sim.state_longest_silence_s=2", "autopilot.state_timeout_s=3"});
  const std::string some = run(load("harbour", settings), "some");
  EXPECT_LT(4 * messages_in<vehicle_state_t>(some).size(), messages_in<vehicle_state_t>(all).size());

  const auto exact = messages_in<link_table_t>(all), reckoned = messages_in<link_table_t>(some);
  ASSERT_EQ(reckoned.size(), exact.size());
  // Either end by the bound, and by 0.15 s at 0.3 m/s, more than their velocities change in a silence.
  const double allowed_m = 2 * (bound_m + 0.15 * 0.3), slowest_mps = 1480;
  double furthest_m = 0;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    ASSERT_EQ(reckoned[k].first, exact[k].first);
    ASSERT_EQ(reckoned[k].second.peers.size(), exact[k].second.peers.size());
    for (std::size_t i = 0; i < exact[k].second.peers.size(); ++i) {
      const auto &a = exact[k].second.peers[i], &b = reckoned[k].second.peers[i];
      furthest_m = std::max(furthest_m, std::abs(a.range_m - b.range_m));
      EXPECT_LE(std::abs(a.delay_s - b.delay_s), allowed_m / slowest_mps);
      EXPECT_LE(b.transmitter_age_s, 2 + 0.05);
    }
  }
  EXPECT_LE(furthest_m, allowed_m);
  EXPECT_GT(furthest_m, 0.05) << "nobody strayed: the test is too easy";
}

TEST_F(EmbeddedRunTest, AScheduledChangeOfWaterIsReplayedToo) {
  ScenarioConfig config = harbour();
  config.channel_server.changes = {{10.4, 14, {}, -1.5, {}}};
  const std::string original = run(config, "original");
  std::vector<std::pair<std::int64_t, double>> winds;
  for (const auto& [channel, water] : messages_in<environment_t>(original)) {
    winds.emplace_back(water.utime, water.wind_speed_mps);
  }
  ASSERT_GE(winds.size(), 2u);
  EXPECT_EQ(winds.front().second, 4);
  EXPECT_EQ(winds.back(), std::pair(std::int64_t{10'400'000}, 14.0));
  const std::string again = replay(config, original, "again");
  const std::vector<std::string> answers{"LINKS", "OUTCOME", "RECEIPT", "RECEIVE", "ENVIRONMENT"};
  EXPECT_TRUE(bytes_of_families(original, answers) == bytes_of_families(again, answers));
}

// A client that announces at 9 s that the wind rises at 10.4 s.
class Forecast : public bus::Node {
 public:
  using Node::Node;
  bus::Due on_due() const override {
    return {.sim = published_ ? SimTime::never() : SimTime::from_seconds(9)};
  }
  void on_step(const bus::Now& now) override {
    if (published_ || now.sim < SimTime::from_seconds(9)) return;
    published_ = true;
    environment_change_t change{};
    change.utime = 10'400'000;
    change.session = 77;
    change.sets_wind = 1;
    change.wind_speed_mps = 14;
    bus().publish(bus::channels::kSetEnvironment, change);
  }
  std::string status_text() const override { return "the wind will rise"; }

 private:
  bool published_ = false;
};

TEST_F(EmbeddedRunTest, AChangeOfWaterReceivedOnTheBusIsReplayed) {
  const std::string original = run(
      harbour(), "original", [] { return false; },
      [](lcm::LCM& lcm) {
        return std::make_unique<Forecast>(lcm, bus::NodeIdentity{"forecast", 77});
      });
  ASSERT_EQ(messages_in<environment_change_t>(original).size(), 1u);
  ASSERT_EQ(messages_in<environment_t>(original).back().second.wind_speed_mps, 14);
  const std::string again = replay(harbour(), original, "again");
  EXPECT_EQ(messages_in<environment_t>(again).back().second.utime, 10'400'000);
  const std::vector<std::string> answers{"LINKS", "OUTCOME", "RECEIPT", "RECEIVE", "ENVIRONMENT"};
  EXPECT_TRUE(bytes_of_families(original, answers) == bytes_of_families(again, answers));
}

TEST_F(EmbeddedRunTest, ReplayOfAReplayStaysTheSame) {
  const std::string original = run(harbour(), "original");
  const std::string again = replay(harbour(), original, "again");
  EXPECT_TRUE(bytes_of(again) == bytes_of(replay(harbour(), again, "once-more")));
}

TEST_F(EmbeddedRunTest, ReplayInOtherWaterGivesOtherAnswers) {
  const std::string original = run(harbour(), "original");
  ScenarioConfig windy = harbour();
  windy.channel_server.environment.noise.wind_mps += 10;
  const std::string again = replay(windy, original, "again");
  const auto before = messages_in<link_table_t>(original), after = messages_in<link_table_t>(again);
  ASSERT_EQ(before.size(), after.size());
  EXPECT_GT(after.back().second.peers[0].noise_level_db, before.back().second.peers[0].noise_level_db + 1);
}

TEST_F(EmbeddedRunTest, InterruptedRunLeavesASoundLog) {
  int instants = 0;
  const std::string path = run(harbour(), "cut", [&] { return ++instants > 200; });
  LogReader log(path);
  std::int64_t events = 0;
  for (LoggedEvent event; log.next(event);) ++events;
  EXPECT_GT(events, 100);
  EXPECT_FALSE(log.truncated());
  EXPECT_EQ(log.bytes_skipped(), 0);
}

TEST_F(EmbeddedRunTest, VehiclesFollowTheirMissions) {
  const std::string log = run(load("seamount", {"scenario.duration_s=60"}), "log");
  double deepest = 0;
  for (const auto& [channel, state] : messages_in<vehicle_state_t>(log)) {
    if (channel == "STATE.auv-1") deepest = std::max(deepest, state.position_ned_m[2]);
  }
  EXPECT_GT(deepest, 40);  // from 30 m towards the first waypoint's 60 m
}

}  // namespace
}  // namespace halocline::clients
