// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/sources/log_nodes.h"

#include <cstdint>
#include <exception>
#include <string_view>
#include <utility>

#include <lcm/lcm-cpp.hpp>

#include "bus/config/scenario.h"
#include "bus/messages/channels.h"
#include "bus/messages/messages.h"
#include "bus/runtime/lockstep_runner.h"
#include "bus/runtime/node.h"
#include "core/sim_time.h"
#include "simulation/composition.h"
#include "viewer/sources/modems.h"

namespace halocline::monitor {
namespace {

// Node that publishes the messages given to it, and passes on the replies, SCENARIO and TERRAIN of the other
// nodes.
class DeskNode : public bus::Node {
 public:
  using Receive = std::function<void(std::string channel, bus::Bytes bytes)>;
  DeskNode(lcm::LCM& lcm, const Receive& receive) : Node(lcm, {"monitor", 1, bus::Stage::kClients}) {
    bus().subscribe_to_all([receive](std::string_view channel, const void* data, std::size_t size) {
      const bool is_shown = channel == bus::channels::kScenario || channel == bus::channels::kTerrain ||
                            channel.starts_with(bus::channels::kLinkReply.prefix) ||
                            channel.starts_with(bus::channels::kTerrainReply.prefix);
      const auto* bytes = static_cast<const std::uint8_t*>(data);
      if (is_shown) receive(std::string(channel), {bytes, bytes + size});
    });
  }

  void put(std::vector<BusMessage> messages) {
    for (BusMessage& message : messages) waiting_.push_back(std::move(message));
    note_due_changed();
  }

 protected:
  bus::Due on_due() const override {
    return {.sim = waiting_.empty() ? SimTime::never() : SimTime::at_once()};
  }
  void on_step(const bus::Now&) override {
    for (const BusMessage& message : std::exchange(waiting_, {}))
      bus().publish_bytes(message.channel, message.bytes.data(), message.bytes.size());
  }
  std::string status_text() const override { return ""; }

 private:
  std::vector<BusMessage> waiting_;
};

// Replaces the named ends of a query by their positions and the modems that the configuration gives the
// vehicles.
bus::Bytes with_modems(const clients::ScenarioConfig& config, link_query_t query) {
  const auto modems = channel_server::make_modems(config.channel_server);
  for (auto* ends : {&query.transmitters, &query.receivers}) {
    for (link_end_t& end : *ends) {
      if (end.vehicle_name.empty()) continue;
      end.modem = modem_message(modems.of(end.vehicle_name), SimTime());
      end.modem_choice = link_end_t::MODEM_GIVEN;
      end.vehicle_name.clear();
    }
  }
  return bus::encoded(query);
}

}  // namespace

LogNodes::LogNodes(OpenConfiguration open) : open_(std::move(open)), thread_([this] { run(); }) {}

LogNodes::~LogNodes() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  posted_or_ended_.notify_one();
  thread_.join();
}

void LogNodes::post(const std::string& channel, bus::Bytes bytes) {
  constexpr std::size_t kMaxPostedMessages = 100;
  {
    const std::lock_guard lock(mutex_);
    if (posted_.size() < kMaxPostedMessages) posted_.push_back({0, channel, std::move(bytes)});
  }
  posted_or_ended_.notify_one();
}

std::string LogNodes::problem() const {
  const std::lock_guard lock(mutex_);
  return problem_;
}

void LogNodes::run() {
  try {
    serve();
  } catch (const std::exception& problem) {
    const std::lock_guard lock(mutex_);
    problem_ = problem.what();
  }
  is_ready_ = false;
}

void LogNodes::serve() {
  constexpr SimDuration kTurn = SimDuration::from_milliseconds(200);
  bus::ConfigFile file = open_();
  clients::ScenarioConfig config = clients::load_scenario(file, clients::ScenarioUse::kWater);
  config.channel_server.rules.medium.shard = {};
  config.channel_server.changes.clear();  // their times are not those of the log
  lcm::LCM lcm("memq://");
  const auto hand_over = [this](std::string channel, bus::Bytes bytes) {
    std::vector<BusMessage> one(1);
    one.front() = {0, std::move(channel), std::move(bytes)};
    handover_.put(std::move(one));
  };
  DeskNode desk(lcm, hand_over);
  for (const bus::VehicleEntry& vehicle : config.scenario.vehicles) {
    const auto modem = channel_server::make_modems(config.channel_server).of(vehicle.name);
    hand_over(bus::channels::kModem.of(vehicle.name), bus::encoded(modem_message(modem, SimTime())));
  }
  clients::Composition nodes(lcm, config, clients::Composition::kReplay, &desk);
  bus::LockstepRunner runner(nodes.nodes());
  runner.run_until(SimTime() + kTurn);
  is_ready_ = true;
  for (;;) {
    std::vector<BusMessage> posted;
    {
      std::unique_lock lock(mutex_);
      posted_or_ended_.wait(lock, [this] { return ends_ || !posted_.empty(); });
      if (ends_) return;
      posted.swap(posted_);
    }
    for (BusMessage& message : posted) {
      if (message.channel != bus::channels::kLinkQuery) continue;
      if (auto query = bus::decoded<link_query_t>(message.bytes))
        message.bytes = with_modems(config, std::move(*query));
    }
    desk.put(std::move(posted));
    runner.run_until(runner.now() + kTurn);
  }
}

}  // namespace halocline::monitor
