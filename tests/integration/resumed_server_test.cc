// SPDX-License-Identifier: BSD-3-Clause
// Channel servers that are killed (SIGKILL) while packets are under way for seconds, on udpm in real time,
// and return with their journal: every packet that a receipt accepts has one outcome at each other vehicle,
// and every reception that the ledger names arrives, once. Runs inside a network namespace of its own
// (scripts/isolated).
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "bus/bus.h"
#include "bus/runtime/node_process.h"
#include "bus/transport/node_identity.h"
#include "bus/transport/transport.h"
#include "clients/modem/blocking_modem.h"
#include "clients/modem/modem_client.h"
#include "core/sim_time.h"
#include "tests/integration/bus_listener.h"
#include "tests/support/process.h"

namespace halocline {
namespace {

using testing::Process;

const char* const kScenario = HALOCLINE_TEST_DATA "/scenarios/far_apart.toml";
constexpr int kVehicles = 5;

// Sender, session, sequence and receiver of a packet.
using AtReceiver = std::tuple<std::int32_t, std::int64_t, std::int64_t, std::int32_t>;

// Receives the ledger, and counts what is lost on the way to it.
class Auditor : public testing::BusListener {
 public:
  Auditor() : BusListener("auditor") {
    bus_.subscribe<modem_receipt_t>(bus::channels::kReceipt, [this](std::string_view vehicle, const auto& m) {
      if (m.receipt_result != modem_receipt_t::ACCEPTED && m.receipt_result != modem_receipt_t::QUEUED)
        return;
      const std::int32_t id = vehicle.back() - '0' + 1;  // "v3" has the id 4
      accepted.emplace(id, m.send_session, m.packet_sequence);
    });
    bus_.subscribe<packet_outcome_t>(bus::channels::kOutcome, [this](const packet_outcome_t& m) {
      ++outcomes[{m.source_id, m.send_session, m.packet_sequence, m.receiver_id}];
      const bool addressed = m.destination_id == m.receiver_id || m.destination_id == kBroadcastId;
      if (m.outcome == packet_outcome_t::RECEIVED && addressed)
        named.emplace(m.source_id, m.send_session, m.packet_sequence, m.receiver_id);
    });
    bus_.subscribe<modem_receive_t>(bus::channels::kReceive, [this](std::string_view, const auto& m) {
      ++received[{m.source_id, m.send_session, m.packet_sequence, m.receiver_id}];
    });
    bus_.subscribe<node_status_t>(bus::channels::kStatus, [this](std::string_view node, const auto& m) {
      late[{std::string(node), m.session}] = m.late;
    });
  }

  // Pairs of an accepted packet and another vehicle that have no outcome.
  std::size_t missing_outcomes() const {
    std::size_t missing = 0;
    for (const auto& [source, session, sequence] : accepted) {
      for (std::int32_t receiver = 1; receiver <= kVehicles; ++receiver)
        missing += receiver != source && !outcomes.contains({source, session, sequence, receiver});
    }
    return missing;
  }

  std::set<std::tuple<std::int32_t, std::int64_t, std::int64_t>> accepted;
  std::map<AtReceiver, int> outcomes, received;
  std::set<AtReceiver> named;
  std::map<std::pair<std::string, std::int64_t>, std::int64_t> late;  // by node and incarnation
};

class ResumedServer : public ::testing::TestWithParam<std::tuple<int, double>> {
 protected:
  ResumedServer() : folder_(::testing::TempDir() + "halocline-resumed-" + std::to_string(getpid())) {
    std::filesystem::create_directories(folder_);
  }
  ~ResumedServer() override {
    processes_.clear();
    std::filesystem::remove_all(folder_);
  }
  void start(const std::string& program) {
    processes_[program] = std::make_unique<Process>(command(program));
  }
  void start_server(int shard) {
    auto words = command("halocline-channel-server");
    const std::string share = std::to_string(shard) + "/" + std::to_string(std::get<0>(GetParam()));
    words.insert(words.end(), {"--journal", folder_ + "/journal-" + std::to_string(shard), "--shard", share});
    processes_["server" + std::to_string(shard)] = std::make_unique<Process>(words);
  }
  static std::vector<std::string> command(const std::string& program) {
    std::vector<std::string> words;
    if (const double loss = std::get<1>(GetParam()); loss > 0) {
      words = {"/usr/bin/env", "LD_PRELOAD=" HALOCLINE_LOSSY_UDP,
               "HALOCLINE_UDP_LOSS=" + std::to_string(loss)};
    }
    words.insert(words.end(), {HALOCLINE_BIN_DIR "/" + program, kScenario});
    return words;
  }

  std::string folder_;
  std::map<std::string, std::unique_ptr<Process>> processes_;
};

TEST_P(ResumedServer, PublishesOneOutcomeOfEveryPacketAtEachReceiver) {
  const int shards = std::get<0>(GetParam());
  Auditor auditor;
  for (const char* program :
       {"halocline-conductor", "halocline-bathymetry", "halocline-vehicle-sim", "halocline-traffic"}) {
    start(program);
  }
  for (int shard = 0; shard < shards; ++shard) start_server(shard);
  auditor.listen_until([&] { return auditor.accepted.size() >= 10; });
  auditor.listen_for(5);
  std::string output;
  for (int kill = 0; kill < 6; ++kill) {
    const int shard = kill % shards;
    Process& server = *processes_.at("server" + std::to_string(shard));
    server.signal(SIGKILL);
    server.wait();
    output += server.output();
    auditor.listen_for(0.4 + 0.25 * kill);  // up to 1.65 s away
    start_server(shard);
    auditor.listen_for(2);
  }
  processes_.at("halocline-traffic")->signal(SIGTERM);
  auditor.listen_for(10);  // the sound under way arrives
  auditor.listen_until([&] { return auditor.outcomes.size() >= auditor.accepted.size() * (kVehicles - 1); });
  for (int shard = 0; shard < shards; ++shard)
    output += processes_.at("server" + std::to_string(shard))->output();

  EXPECT_GT(auditor.accepted.size(), 60u) << output;
  EXPECT_EQ(auditor.missing_outcomes(), 0u) << "of " << auditor.accepted.size() * (kVehicles - 1) << output;
  EXPECT_EQ(auditor.outcomes.size(), auditor.accepted.size() * (kVehicles - 1))
      << "outcomes without a receipt";
  for (const auto& [packet, times] : auditor.outcomes) EXPECT_EQ(times, 1);
  EXPECT_EQ(auditor.received.size(), auditor.named.size());
  for (const auto& [packet, times] : auditor.received) EXPECT_EQ(times, 1);
  for (const AtReceiver& packet : auditor.named) EXPECT_TRUE(auditor.received.contains(packet));
  EXPECT_EQ(auditor.counters().lost, 0);
  EXPECT_THAT(output, ::testing::HasSubstr("resumed"));
  std::int64_t late = 0;
  for (const auto& [incarnation, count] : auditor.late) late += count;
  EXPECT_GT(late, 0) << "nothing was due while a server was down: not much of a test";
  std::printf("%zu packets, %zu outcomes, %zu receptions, %lld of them late\n", auditor.accepted.size(),
              auditor.outcomes.size(), auditor.received.size(), static_cast<long long>(late));
}

// Another server answers the packet, so its sender does not repeat it.
TEST_P(ResumedServer, HasTheOutcomesOfVehiclesThatFirstSentWhileItWasAway) {
  const int shards = std::get<0>(GetParam());
  Auditor auditor;
  for (const char* program : {"halocline-conductor", "halocline-bathymetry", "halocline-vehicle-sim"})
    start(program);
  for (int shard = 0; shard < shards; ++shard) start_server(shard);
  const auto lcm = bus::open_transport(bus::effective_url(""));
  std::vector<std::unique_ptr<clients::BlockingModem>> modems;
  for (std::int32_t id = 1; id <= kVehicles; ++id) {
    modems.push_back(std::make_unique<clients::BlockingModem>(
        *lcm, clients::ModemAddress{
                  .vehicle = "v" + std::to_string(id - 1), .vehicle_id = id, .session = 100 + id}));
  }
  const auto listen_for = [&](double seconds) {
    auditor.listen_until(seconds, [&] {
      for (const auto& modem : modems) (void)modem->wait_receive(SimDuration());
      return false;
    });
  };
  listen_for(3);
  std::string output;
  for (int i = 0; i < kVehicles; ++i) {
    const std::string name = "server" + std::to_string(i % shards);
    processes_.at(name)->signal(SIGKILL);
    processes_.at(name)->wait();
    output += processes_.at(name)->output();
    ASSERT_TRUE(modems[static_cast<std::size_t>(i)]->send(kBroadcastId, std::vector<std::uint8_t>{1, 2, 3}));
    listen_for(0.5);
    start_server(i % shards);
    listen_for(2.5);
  }
  listen_for(10);  // the sound under way arrives
  for (int shard = 0; shard < shards; ++shard)
    output += processes_.at("server" + std::to_string(shard))->output();
  EXPECT_EQ(auditor.accepted.size(), std::size_t{kVehicles}) << output;
  EXPECT_EQ(auditor.missing_outcomes(), 0u) << output;
  for (const auto& [packet, times] : auditor.outcomes) EXPECT_EQ(times, 1);
}

INSTANTIATE_TEST_SUITE_P(Servers, ResumedServer,
                         ::testing::Values(std::tuple(1, 0.0), std::tuple(2, 0.0), std::tuple(2, 0.05)),
                         [](const auto& kind) {
                           return std::to_string(std::get<0>(kind.param)) + "Servers" +
                                  (std::get<1>(kind.param) > 0 ? "5PercentLost" : "");
                         });

}  // namespace
}  // namespace halocline
