// All programs as separate processes on a bus that loses a fifth of all datagrams: what the ledger names as
// received is received. Runs inside a network namespace of its own (scripts/isolated).
//
// HALOCLINE_LOSSY_SECONDS sets how long they talk (default 20 s).
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "bus/bus.h"
#include "bus/node_process.h"
#include "bus/transport.h"
#include "clients/modem/blocking_modem.h"
#include "tests/support/process.h"

namespace halocline {
namespace {

using testing::Process;

const char* const kScenario = HALOCLINE_TEST_DATA "/scenarios/ten_vehicles.toml";
constexpr int kVehicles = 10;

double seconds_of_talk() {
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

// Hears the ledger, the farewells of the programs, and what the bus lost.
class Auditor {
 public:
  Auditor() : lcm_(bus::open_transport(bus::effective_url(""))), bus_(*lcm_, {"auditor", 4711}) {
    bus_.enable_repair();
    bus_.subscribe<packet_outcome_t>(bus::channels::kOutcome, [this](const packet_outcome_t& outcome) {
      const bool for_receiver =
          outcome.destination_id == outcome.receiver_id || outcome.destination_id == kBroadcastId;
      if (outcome.packet_fate != packet_outcome_t::RECEIVED || !for_receiver) return;
      named.emplace(outcome.source_id, outcome.send_session, outcome.packet_sequence, outcome.receiver_id);
    });
    bus_.subscribe<node_status_t>(bus::channels::kStatus,
                                  [this](std::string_view node, const node_status_t& status) {
                                    last_status[std::string(node)] = status;
                                  });
  }
  void listen() {
    bus_.set_steady(bus::steady_now());
    while (lcm_->handleTimeout(0) > 0) {
    }
    bus_.rethrow_if_failed();
    bus_.repair(SimTime(), bus::steady_now());
  }
  const bus::BusCounters& counters() const { return bus_.counters(); }

  std::set<Reception> named;
  std::map<std::string, node_status_t> last_status;

 private:
  std::unique_ptr<lcm::LCM> lcm_;
  bus::Bus bus_;
};

class LossyBus : public ::testing::Test {
 protected:
  LossyBus() {
    for (int i = 0; i < kVehicles; ++i) clients_.push_back(std::make_unique<Client>(i));
  }
  void start(const std::string& program) {
    processes_[program] =
        std::make_unique<Process>(std::vector<std::string>{HALOCLINE_BIN_DIR "/" + program, kScenario});
  }
  void pass(double seconds) {
    const SimTime end = bus::steady_now() + SimDuration::from_seconds(seconds);
    while (bus::steady_now() < end) {
      auditor_.listen();
      for (const auto& client : clients_) client->take(received_);
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }

  std::vector<std::unique_ptr<Client>> clients_;
  Auditor auditor_;
  std::set<Reception> received_;
  std::map<std::string, std::unique_ptr<Process>> processes_;
};

TEST_F(LossyBus, NotOneReceptionThatTheLedgerNamesIsMissingAtAClient) {
  ASSERT_EQ(std::system(HALOCLINE_SOURCE_DIR "/scripts/lose 20"), 0);
  for (const char* program : {"halocline-conductor", "halocline-bathymetry", "halocline-vehicle-sim",
                              "halocline-channel-server", "halocline-autopilot", "halocline-traffic"}) {
    start(program);
  }
  pass(seconds_of_talk());
  processes_.at("halocline-traffic")->signal(SIGTERM);
  pass(6);  // the sound under way arrives, and what was lost last is repaired

  EXPECT_GT(auditor_.named.size(), static_cast<std::size_t>(seconds_of_talk())) << "too few to tell";
  std::size_t missing = 0;
  for (const Reception& reception : auditor_.named) missing += received_.count(reception) == 0 ? 1 : 0;
  EXPECT_EQ(missing, 0u) << "of " << auditor_.named.size();
  EXPECT_GT(auditor_.counters().repaired, 0) << "nothing was lost: not much of a test";
  EXPECT_EQ(auditor_.counters().lost, 0);
  const node_status_t server = auditor_.last_status["channel-server"];
  EXPECT_GT(server.repaired, 0);
  EXPECT_EQ(server.lost, 0);
  RecordProperty("named", static_cast<int>(auditor_.named.size()));
  RecordProperty("repaired_at_the_server", static_cast<int>(server.repaired));
  std::printf("received %zu, repaired by the auditor %lld, by the channel server %lld\n",
              auditor_.named.size(), static_cast<long long>(auditor_.counters().repaired),
              static_cast<long long>(server.repaired));
}

}  // namespace
}  // namespace halocline
