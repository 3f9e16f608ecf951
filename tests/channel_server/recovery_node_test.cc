// SPDX-License-Identifier: BSD-3-Clause
// A channel server that is killed while packets are under way, and restarted with its journal, publishes in
// both incarnations together what an uninterrupted one publishes: nothing twice, nothing missing, the same
// numbers.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "bus/transport/event_log.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "tests/channel_server/node_bench.h"
#include "tests/channel_server/water_models.h"

namespace halocline::channel_server {
namespace {

using testing::NodeBench;

constexpr VehicleId kVehicles = 4;
constexpr double kBottomM = 200;

// The bytes of a message without session and sequence number.
template <class Message>
std::string unnumbered(Message message) {
  message.session = message.sequence = 0;
  std::string bytes(static_cast<std::size_t>(message.getEncodedSize()), '\0');
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

VehicleModem reporting_modem() {
  VehicleModem modem = testing::quick_modem();
  modem.listening.events = true;
  return modem;
}

// One incarnation of a server, beside the bathymetry service.
struct Incarnation {
  Incarnation(bool rays, const std::string& journal)
      : bench({}, {reporting_modem(), {}},
              rays ? ray_model(testing::even_water(), {}, {}) : straight_model(testing::even_water())),
        bottom(bench.lcm(), kBottomM) {
    if (!journal.empty()) bench.node().open_journal(journal);
  }
  void publish_states(double t) {
    for (VehicleId id = 1; id <= kVehicles; ++id)
      bench.state(id, t, {2000.0 * id + t, 40.0 * id - 2 * t, 60}, {1, -2, 0});
  }
  // What four vehicles, two to six kilometres apart, publish in a tenth of a second: two send at times, of
  // which one pings; and one sleeps at times.
  void publish(int tenth) {
    const double t = tenth / 10.0;
    publish_states(t);
    if (tenth % 50 == 20) {  // sleeps for two seconds
      modem_listen_t listen{};
      listen.asleep = listen.events = 1;
      listen.wake_utime = (tenth + 21) * 100'000LL;
      bench.listen(4, t + 0.1, listen);
    }
    if (tenth % 7 == 3) bench.send(1 + tenth % kVehicles, t + 0.02, tenth, 20);
    if (tenth % 23 != 5) return;
    modem_send_t ping = bench.send(2, t + 0.3, 10'000 + tenth, 1, 3);
    ping.packet_kind = modem_send_t::PING;
    ping.packet_sequence += 10'000;
    ping.utime += 400'000;
    bench.bus().publish(testing::channels::kSend.of(testing::name_of(2)), ping);
  }
  void run(int from_tenth, int to_tenth) {
    for (int tenth = from_tenth; tenth < to_tenth; ++tenth) {
      publish(tenth);
      bench.run_to(tenth / 10.0 + 0.0999);
    }
  }
  // As on a loaded machine: steps come late, and take the inputs of a second and a half at once.
  void run_late(int from_tenth, int to_tenth) {
    for (int tenth = from_tenth; tenth < to_tenth; ++tenth) {
      publish(tenth);
      if (tenth % 15 == 14) bench.step(tenth / 10.0 + 0.0999);
    }
  }

  NodeBench bench;
  testing::FlatBottom bottom;
};

struct Published {
  std::multiset<std::string> outcomes, receives, receipts, events;
  std::multiset<double> arrivals_s;
  void add(const NodeBench& bench) {
    for (const auto& m : bench.outcomes) outcomes.insert(unnumbered(m));
    for (const auto& m : bench.receives) receives.insert(m.channel + unnumbered(m.message));
    for (const auto& m : bench.receipts) receipts.insert(m.channel + unnumbered(m.message));
    for (const auto& m : bench.events) events.insert(m.channel + unnumbered(m.message));
  }
};

class RecoveringServer : public ::testing::TestWithParam<bool> {
 protected:
  RecoveringServer() { bus::set_log_level(bus::LogLevel::kSilent); }
  ~RecoveringServer() override { forget(); }
  void forget() {
    for (const char* part : {"", ".1"}) std::filesystem::remove(journal_ + part);
  }

  // Killed at each of `kills` (tenths of a second), and restarted `away` tenths later; what was published
  // meanwhile is repaired.
  Published with_kills(const std::vector<int>& kills, int away) {
    forget();
    Published published;
    int tenth = 0;
    auto server = std::make_unique<Incarnation>(GetParam(), journal_);
    for (const int kill : kills) {
      server->run(tenth, kill);
      published.add(server->bench);
      late_ += server->bench.node().counters().late;
      server = std::make_unique<Incarnation>(GetParam(), journal_);
      for (tenth = kill; tenth < kill + away; ++tenth) server->publish(tenth);
      server->bench.step((tenth - 1) / 10.0 + 0.0999);
    }
    server->run(tenth, kTenths);
    server->bench.run_to(kTenths / 10.0 + 20);
    published.add(server->bench);
    late_ += server->bench.node().counters().late;
    return published;
  }

  static constexpr int kTenths = 400;
  const std::string journal_ = ::testing::TempDir() + "halocline-journal-" + std::to_string(getpid());
  std::int64_t late_ = 0;
};

TEST_P(RecoveringServer, PublishesInAllIncarnationsWhatAnUninterruptedServerPublishes) {
  const Published one = with_kills({}, 0);
  EXPECT_GT(one.outcomes.size(), 150u);
  EXPECT_GT(one.receives.size(), 30u);
  EXPECT_EQ(late_, 0);
  const Published several = with_kills({51, 123, 142, 266, 301}, 12);
  EXPECT_TRUE(several.outcomes == one.outcomes);
  EXPECT_TRUE(several.receives == one.receives);
  EXPECT_TRUE(several.receipts.size() == one.receipts.size());
  EXPECT_GT(one.events.size(), 200u);
  EXPECT_TRUE(several.events == one.events);
  EXPECT_GT(late_, 5) << "nothing was due while it was away: not much of a test";
}

// What was due before a late step happened after its inputs were known, and does so when the step is done
// again.
TEST_P(RecoveringServer, ThatStepsLateAgreesWithItsEarlierIncarnation) {
  Published several;
  for (const int begin : {0, 105, 210, 315}) {
    Incarnation server(GetParam(), journal_);
    server.run_late(begin, begin + 105);
    if (begin == 315) server.bench.run_to(60);
    several.add(server.bench);
  }
  forget();
  Published one;
  Incarnation server(GetParam(), journal_);
  server.run_late(0, 420);
  server.bench.run_to(60);
  one.add(server.bench);
  EXPECT_GT(one.receives.size(), 30u);
  EXPECT_TRUE(several.outcomes == one.outcomes);
  EXPECT_TRUE(several.receives == one.receives);
}

TEST_P(RecoveringServer, WithoutAJournalLosesWhatWasUnderWay) {
  const Published one = with_kills({}, 0);
  Incarnation first(GetParam(), "");
  first.run(0, 200);
  Incarnation second(GetParam(), "");
  second.run(200, kTenths);
  second.bench.run_to(kTenths / 10.0 + 20);
  EXPECT_LT(first.bench.outcomes.size() + second.bench.outcomes.size(), one.outcomes.size());
}

TEST_P(RecoveringServer, GoesOnWithTheNumbersOfItsFlows) {
  Incarnation first(GetParam(), journal_);
  first.run(0, 100);
  ASSERT_FALSE(first.bench.outcomes.empty());
  Incarnation second(GetParam(), journal_);
  second.bench.step(10.0);
  second.run(100, 200);
  ASSERT_FALSE(second.bench.outcomes.empty());
  EXPECT_EQ(second.bench.outcomes.front().session, first.bench.outcomes.back().session);
  EXPECT_EQ(second.bench.outcomes.front().sequence, first.bench.outcomes.back().sequence + 1);
}

// The last SEND of each flow stays in the journal, for its number.
TEST_P(RecoveringServer, AnswersNoPacketOfLongAgoAgain) {
  Incarnation first(GetParam(), journal_);
  first.run(0, 100);
  for (int second = 10; second < 200; ++second) {
    first.publish_states(second);
    first.bench.run_to(second + 0.5);
  }
  ASSERT_FALSE(first.bench.receipts.empty());
  Incarnation second(GetParam(), journal_);
  second.publish_states(200);
  second.bench.step(200.5);
  second.bench.run_to(205);
  EXPECT_TRUE(second.bench.receipts.empty());
  EXPECT_TRUE(second.bench.outcomes.empty());
  ASSERT_FALSE(second.bench.links.empty()) << "it did not resume";
}

// As one whose bathymetry service is away decides by other paths.
TEST_P(RecoveringServer, DeliversNothingThatItsOutcomeDoesNotName) {
  Incarnation first(GetParam(), journal_);
  first.run(0, 200);
  Incarnation second(!GetParam(), journal_);
  for (int tenth = 200; tenth < 206; ++tenth) second.publish(tenth);
  second.bench.step(20.5999);
  second.run(206, 300);
  second.bench.run_to(50);
  std::set<std::tuple<std::int32_t, std::int64_t, std::int32_t>> named;
  std::size_t delivered = 0;
  for (const NodeBench* bench : {&first.bench, &second.bench}) {
    for (const packet_outcome_t& m : bench->outcomes)
      if (m.outcome == packet_outcome_t::RECEIVED)
        named.emplace(m.source_id, m.packet_sequence, m.receiver_id);
  }
  for (const NodeBench* bench : {&first.bench, &second.bench}) {
    delivered += bench->receives.size();
    for (const auto& m : bench->receives)
      EXPECT_TRUE(named.contains({m.message.source_id, m.message.packet_sequence, m.message.receiver_id}));
  }
  EXPECT_GT(delivered, 10u);
}

TEST_P(RecoveringServer, PublishesNoTableOfATickThatPassedWhileItWasAway) {
  Incarnation first(GetParam(), journal_);
  first.run(0, 100);
  Incarnation second(GetParam(), journal_);
  for (int tenth = 100; tenth < 134; ++tenth) second.publish(tenth);
  second.bench.step(13.35);
  second.run(134, 160);
  ASSERT_FALSE(second.bench.links.empty());
  EXPECT_EQ(second.bench.links.front().message.utime, 14'000'000);
}

TEST_P(RecoveringServer, ForgetsTheJournalOfAnotherRun) {
  Incarnation first(GetParam(), journal_);
  first.run(0, 300);
  Incarnation second(GetParam(), journal_);
  second.publish(3);
  second.bench.step(0.5);
  second.run(6, 300);
  second.bench.run_to(50);
  EXPECT_FALSE(second.bench.outcomes.empty());
  EXPECT_EQ(second.bench.outcomes.front().sequence, 0);
}

TEST_P(RecoveringServer, AJournalCutOffWithinAnEntryIsReadUpToThere) {
  Incarnation first(GetParam(), journal_);
  first.run(0, 100);
  std::filesystem::resize_file(journal_, std::filesystem::file_size(journal_) - 7);
  Incarnation second(GetParam(), journal_);
  second.bench.step(10.0);
  second.run(100, 200);
  EXPECT_FALSE(second.bench.outcomes.empty());
}

INSTANTIATE_TEST_SUITE_P(Channel, RecoveringServer, ::testing::Values(false, true),
                         [](const auto& kind) { return kind.param ? "Rays" : "Straight"; });

}  // namespace
}  // namespace halocline::channel_server
