// SPDX-License-Identifier: BSD-3-Clause
// All programs as separate processes on a bus that loses datagrams: what OUTCOME reports as received is
// received, on one host and on several. Runs inside a network namespace of its own (scripts/isolated).
//
// HALOCLINE_LOSSY_SECONDS sets how long they send (default 20 s).
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "bus/bus.h"
#include "bus/runtime/node_process.h"
#include "bus/transport/node_identity.h"
#include "bus/transport/transport.h"
#include "clients/modem/blocking_modem.h"
#include "core/sim_time.h"
#include "tests/integration/bus_listener.h"
#include "tests/integration/network_host.h"
#include "tests/support/process.h"

namespace halocline {
namespace {

using testing::Host;
using testing::Process;

const char* const kScenario = HALOCLINE_TEST_DATA "/scenarios/ten_vehicles.toml";
constexpr int kVehicles = 10;

double sending_seconds() {
  const char* wanted = std::getenv("HALOCLINE_LOSSY_SECONDS");
  return wanted == nullptr ? 20.0 : std::atof(wanted);
}

// Source, session, sequence and receiver of a packet that arrived.
using Reception = std::tuple<std::int32_t, std::int64_t, std::int64_t, std::int32_t>;

// One vehicle's program as a user would write it: a modem of the library, and what it received.
struct Client {
  explicit Client(int number)
      : lcm(bus::open_transport(bus::effective_url(""))),
        modem(*lcm,
              {.vehicle = "v" + std::to_string(number), .vehicle_id = number + 1, .session = 900 + number}) {}
  void take(std::set<Reception>& received) {
    while (const auto packet = modem.wait_receive(SimDuration())) {
      received.emplace(packet->source_id, packet->send_session, packet->packet_sequence, packet->receiver_id);
    }
  }
  std::unique_ptr<lcm::LCM> lcm;
  clients::BlockingModem modem;
};

// Receives the outcomes and the last statuses of the programs, and counts what the bus lost.
class Auditor : public testing::BusListener {
 public:
  Auditor() : BusListener("auditor") {
    bus_.subscribe<packet_outcome_t>(bus::channels::kOutcome, [this](const packet_outcome_t& outcome) {
      ++outcomes[{outcome.source_id, outcome.send_session, outcome.packet_sequence, outcome.receiver_id}];
      servers.insert(outcome.session);
      const bool for_receiver =
          outcome.destination_id == outcome.receiver_id || outcome.destination_id == kBroadcastId;
      if (outcome.outcome != packet_outcome_t::RECEIVED || !for_receiver) return;
      delivered.emplace(outcome.source_id, outcome.send_session, outcome.packet_sequence,
                        outcome.receiver_id);
    });
    bus_.subscribe<node_status_t>(bus::channels::kStatus,
                                  [this](std::string_view node, const node_status_t& status) {
                                    last_status[std::string(node)] = status;
                                  });
  }

  std::set<Reception> delivered;  // by their outcomes
  std::map<Reception, int> outcomes;
  std::set<std::int64_t> servers;  // sessions
  std::map<std::string, node_status_t> last_status;
};

class LossyBus : public ::testing::Test {
 protected:
  // After the network is as it is to be.
  void join_bus() {
    for (int i = 0; i < kVehicles; ++i) clients_.push_back(std::make_unique<Client>(i));
    auditor_.emplace();
  }
  void start(const std::string& program) { start(program, {HALOCLINE_BIN_DIR "/" + program, kScenario}); }
  void start(const std::string& name, const std::vector<std::string>& command) {
    processes_[name] = std::make_unique<Process>(command);
  }
  void pass(double seconds) {
    pass_until(seconds, [] { return false; });
  }
  // At most `seconds`.
  template <class Condition>
  void pass_until(double seconds, Condition condition) {
    const SimTime end = bus::steady_now() + SimDuration::from_seconds(seconds);
    while (bus::steady_now() < end && !condition()) {
      auditor_->dispatch();
      for (const auto& client : clients_) client->take(received_);
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }
  std::size_t missing() const {
    const auto& delivered = auditor_->delivered;
    return static_cast<std::size_t>(
        std::count_if(delivered.begin(), delivered.end(),
                      [&](const Reception& reception) { return !received_.contains(reception); }));
  }
  // The programs on three hosts, this one being a fourth for clients and auditor.
  void start_on_hosts() {
    setenv("LCM_DEFAULT_URL", "udpm://239.255.76.67:7667?ttl=1&recv_buf_size=4194304", 1);
    join_bus();
    for (const char* program :
         {"halocline-conductor", "halocline-vehicle-sim", "halocline-autopilot", "halocline-traffic"}) {
      start_on(0, program);
    }
    start_on(1, "halocline-bathymetry");
    start_on(1, "halocline-channel-server", {"--shard", "0/2"});
    start_on(2, "halocline-channel-server", {"--shard", "1/2"});
  }
  void start_on(std::size_t host, const std::string& program, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{HALOCLINE_BIN_DIR "/" + program, kScenario};
    words.insert(words.end(), more.begin(), more.end());
    start(more.empty() ? program : program + more.back(), hosts_.at(host)->command(words));
  }
  void expect_two_shards_with_each_outcome_once() {
    EXPECT_EQ(auditor_->servers.size(), 2u);
    for (const auto& [reception, times] : auditor_->outcomes) EXPECT_EQ(times, 1);
    for (const char* server : {"channel-server-0", "channel-server-1"}) {
      EXPECT_EQ(auditor_->last_status[server].lost, 0) << server;
    }
  }
  // Lets all send for a while, then stops them, and compares the outcomes with what was received.
  void send_and_compare() {
    pass_until(testing::kHangLimit.count(),
               [this] { return !auditor_->delivered.empty(); });  // a loaded machine starts programs late
    pass(sending_seconds());
    processes_.at("halocline-traffic")->signal(SIGTERM);
    pass(6);  // the sound under way arrives
    pass_until(testing::kHangLimit.count(),
               [this] { return missing() == 0; });  // what was lost last is repaired
    EXPECT_GT(auditor_->delivered.size(), static_cast<std::size_t>(sending_seconds()))
        << "too few for a test";
    EXPECT_EQ(missing(), 0u) << "of " << auditor_->delivered.size();
    EXPECT_GT(auditor_->counters().repaired, 0) << "nothing was lost: not much of a test";
    EXPECT_EQ(auditor_->counters().lost, 0);
    std::printf("received %zu, repaired by the auditor %lld\n", auditor_->delivered.size(),
                static_cast<long long>(auditor_->counters().repaired));
  }

  std::vector<std::unique_ptr<Client>> clients_;
  std::optional<Auditor> auditor_;
  std::set<Reception> received_;
  std::vector<std::unique_ptr<Host>> hosts_;
  std::map<std::string, std::unique_ptr<Process>> processes_;
};

TEST_F(LossyBus, EveryDeliveredPacketReachesItsClient) {
  Host::run(HALOCLINE_SOURCE_DIR "/scripts/lose 20");
  join_bus();
  for (const char* program : {"halocline-conductor", "halocline-bathymetry", "halocline-vehicle-sim",
                              "halocline-channel-server", "halocline-autopilot", "halocline-traffic"}) {
    start(program);
  }
  send_and_compare();
  const node_status_t server = auditor_->last_status["channel-server"];
  EXPECT_GT(server.repaired, 0);
  EXPECT_EQ(server.lost, 0);
  Host::run(HALOCLINE_SOURCE_DIR "/scripts/lose 0");
}

// Vehicles on one host, the seabed on another with one channel server, a second server on a third; clients
// and auditor on a fourth.
TEST_F(LossyBus, ThreeHostsWithTwoShardsPublishEachOutcomeOnce) {
  hosts_ = testing::hosts_on_a_bridge(3, 5);
  start_on_hosts();
  send_and_compare();
  expect_two_shards_with_each_outcome_once();
}

// The same where each frame takes 3 to 7 ms from host to host, so that frames overtake each other, and 5 %
// are lost.
TEST_F(LossyBus, ThreeHostsOnASlowAndUnevenNetworkPublishEachOutcomeOnce) {
  Host::run("ip link add own type veth peer name own-end");
  Host::run("ip addr add 10.99.0.1/24 dev own");
  Host::run("ip link set own up");
  Host::run("ip link set own-end up");
  Host::run("ip route replace 224.0.0.0/4 dev own");
  std::vector<std::string> words{HALOCLINE_SLOW_SWITCH, "1", "5", "2", "0.05", "own-end"};
  for (int i = 0; i < 3; ++i) {
    hosts_.push_back(std::make_unique<Host>(i));
    words.push_back("cable" + std::to_string(i));
  }
  start("switch", words);
  start_on_hosts();
  send_and_compare();
  expect_two_shards_with_each_outcome_once();
  Process& slow_switch = *processes_.at("switch");
  ASSERT_TRUE(slow_switch.running()) << slow_switch.output();
  slow_switch.signal(SIGTERM);
  slow_switch.wait();
  long long copies = 0, lost = 0, overtook = 0;
  ASSERT_EQ(std::sscanf(slow_switch.output().c_str(), "copies=%lld lost=%lld overtook=%lld", &copies, &lost,
                        &overtook),
            3)
      << slow_switch.output();
  EXPECT_NEAR(static_cast<double>(lost) / static_cast<double>(copies), 0.05, 0.01) << copies;
  EXPECT_GT(overtook, copies / 100);
  std::printf("%s", slow_switch.output().c_str());
}

}  // namespace
}  // namespace halocline
