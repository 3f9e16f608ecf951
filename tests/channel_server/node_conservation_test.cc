// SPDX-License-Identifier: BSD-3-Clause
// A long random run through the node on the bus: every accepted packet has one OUTCOME for each possible
// receiver, every RECEIVE an OUTCOME of its own.
#include <cstdint>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "bus/transport/event_log.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/random.h"
#include "tests/channel_server/node_bench.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;
using testing::NodeBench;

double draw(const char* purpose, std::uint64_t which) {
  return uniform_at({.seed = 3, .purpose = purpose_of(purpose), .who = 0, .which = which});
}

TEST(NodeConservation, PacketsTimesReceiversAreOutcomes) {
  bus::set_log_level(bus::LogLevel::kSilent);
  constexpr VehicleId kVehicles = 6;
  constexpr int kSeconds = 300;
  NodeBench bench;
  std::int64_t sequence = 0;
  for (int tenth = 0; tenth < kSeconds * 10; ++tenth) {
    const double t = tenth / 10.0;
    for (VehicleId id = 1; id <= kVehicles; ++id)
      bench.state(id, t, {700.0 * id + t, t * id, 60}, {1, 1.0 * id, 0});
    if (draw("send", static_cast<std::uint64_t>(tenth)) < 0.3) {
      const auto source =
          1 + static_cast<VehicleId>(draw("who", static_cast<std::uint64_t>(tenth)) * kVehicles);
      const double ahead_s =
          draw("ahead", static_cast<std::uint64_t>(tenth)) * 3 - 1;  // some late, some early
      bench.send(source, t + ahead_s, sequence++, 10,
                 static_cast<VehicleId>(draw("to", static_cast<std::uint64_t>(tenth)) * (kVehicles + 1)));
    }
    bench.run_to(t);
  }
  bench.run_to(kSeconds + 20);

  std::set<std::int64_t> accepted;
  for (const auto& receipt : bench.receipts) {
    if (receipt.message.receipt_result == modem_receipt_t::ACCEPTED)
      accepted.insert(receipt.message.packet_sequence);
  }
  EXPECT_EQ(static_cast<std::int64_t>(bench.receipts.size()), sequence);
  EXPECT_GT(accepted.size(), 500u);
  std::map<std::int64_t, std::set<VehicleId>> decided;
  int received = 0;
  for (const auto& outcome : bench.outcomes) {
    EXPECT_TRUE(decided[outcome.packet_sequence].insert(outcome.receiver_id).second);
    const bool addressed = outcome.destination_id == 0 || outcome.destination_id == outcome.receiver_id;
    received += outcome.outcome == packet_outcome_t::RECEIVED && addressed ? 1 : 0;
  }
  EXPECT_EQ(bench.outcomes.size(), accepted.size() * (kVehicles - 1));
  EXPECT_EQ(bench.receives.size(), static_cast<std::size_t>(received));
  EXPECT_GT(bench.node().counters().late, 0);
}

// It was stopped for 75 s; those who were not are that far ahead.
TEST(LaggingServer, StatesAheadOfALaggingServerAreJudgedByTheClock) {
  bus::set_log_level(bus::LogLevel::kSilent);
  NodeBench bench;
  for (double t = 0; t <= 80; t += 0.5) {
    if (t == 5.5) bench.run_to(5);
    bench.state(1, t, {0, 0, 50});
    bench.state(2, t, {3000, 0, 50});
  }
  bench.send(1, 75, 0, 5);
  bench.drain();
  for (double t = 5; t <= 80; t += 0.5) {
    bench.node().step({at_s(t), at_s(80), true, at_s(80)});
    bench.drain();
  }
  EXPECT_EQ(bench.node().counters().refused, 0);
  ASSERT_EQ(bench.outcomes.size(), 1u);
  EXPECT_EQ(bench.outcomes[0].outcome, packet_outcome_t::RECEIVED);
  bench.state(1, 90.1, {0, 0, 50});  // its clock is wrong
  bench.drain();
  bench.node().step({at_s(80), at_s(80), true, at_s(80)});
  EXPECT_EQ(bench.node().counters().refused, 1);
}

}  // namespace
}  // namespace halocline::channel_server
