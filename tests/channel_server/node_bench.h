// SPDX-License-Identifier: BSD-3-Clause
// A channel server on a bus of its own (memq), with vehicles, subscriptions and a bathymetry service that may
// be away.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "acoustics/sea/environment.h"
#include "bus/messages/channels.h"
#include "bus/runtime/node.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/channel_server_node.h"
#include "channel_server/messages/link_messages.h"
#include "channel_server/messages/packet_messages.h"
#include "channel_server/messages/world_messages.h"
#include "channel_server/propagation/straight_propagation.h"
#include "channel_server/vehicles/vehicle_equipment.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "channel_server/water_model.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/channel_server/flat_bottom.h"
#include "tests/channel_server/water_models.h"

namespace halocline::channel_server::testing {

namespace channels = bus::channels;

// A message received, with its channel.
template <class Message>
struct ReceivedOn {
  std::string channel;
  Message message;
};

// Straight paths over a bottom that nobody asks for.
inline WaterModel without_bottom(const acoustics::Environment& water) {
  WaterModel model = straight_model(water);
  model.propagation = std::make_unique<StraightPropagation>(model.waters);
  return model;
}

class NodeBench {
 public:
  static constexpr std::int64_t kSession = 4711;

  explicit NodeBench(ServerRules rules = {}, ConfiguredModems modems = {quick_modem(), {}},
                     const acoustics::Environment& water = even_water())
      : NodeBench(std::move(rules), std::move(modems), without_bottom(water)) {}
  NodeBench(ServerRules rules, ConfiguredModems modems, WaterModel water, VehicleEquipment equipment = {})
      : lcm_("memq://"),
        node_(lcm_, {"channel-server", kSession}, std::move(water), modems, rules, {}, std::move(equipment)),
        bus_(lcm_, {"test", 1}) {
    record(channels::kLinks, links);
    record(channels::kReceipt, receipts);
    record(channels::kReceive, receives);
    record(channels::kModemEvent, events);
    record(channels::kLinkReply, replies);
    record(channels::kStatus, statuses);
    bus_.subscribe<packet_outcome_t>(channels::kOutcome,
                                     [this](const packet_outcome_t& m) { outcomes.push_back(m); });
    bus_.subscribe<environment_t>(channels::kEnvironment,
                                  [this](const environment_t& m) { environments.push_back(m); });
  }

  lcm::LCM& lcm() { return lcm_; }
  ChannelServerNode& node() { return node_; }
  bus::Bus& bus() { return bus_; }

  void state(VehicleId id, double time_s, const Vec3& position, const Vec3& velocity = Vec3::Zero()) {
    state_of(name_of(id), id, time_s, position, velocity);
  }
  void state_of(const std::string& name, VehicleId id, double time_s, const Vec3& position,
                const Vec3& velocity = Vec3::Zero()) {
    vehicle_state_t message{};
    message.utime = at_s(time_s).to_utime();
    message.vehicle_id = id;
    message.orientation_wxyz[0] = 1;
    for (int i = 0; i < 3; ++i) {
      message.position_ned_m[i] = position[i];
      message.velocity_ned_mps[i] = velocity[i];
    }
    bus_.publish(channels::kState.of(name), message);
  }
  modem_send_t send(VehicleId source, double time_s, std::int64_t sequence, std::int32_t bytes = 1,
                    VehicleId destination = 0) {
    modem_send_t message{};
    message.utime = at_s(time_s).to_utime();
    message.session = 7;
    message.packet_sequence = sequence;
    message.source_id = source;
    message.destination_id = destination;
    message.stamped = 1;
    message.payload_size = bytes;
    message.payload.assign(static_cast<std::size_t>(bytes), 0x42);
    bus_.publish(channels::kSend.of(name_of(source)), message);
    return message;
  }

  // Nothing repeated: what is not set is off.
  void listen(VehicleId id, double time_s, modem_listen_t message) {
    message.utime = at_s(time_s).to_utime();
    bus_.publish(channels::kListen.of(name_of(id)), message);
  }

  environment_change_t change_of_wind(double time_s, double wind_mps, std::int64_t sequence = 0) {
    environment_change_t message{};
    message.utime = at_s(time_s).to_utime();
    message.session = 7;
    message.sequence = sequence;
    message.sets_wind = 1;
    message.wind_speed_mps = wind_mps;
    return message;
  }
  void change(const environment_change_t& message) { bus_.publish(channels::kSetEnvironment, message); }

  // Steps at `time_s` until the node wants no more at that instant. `known` false: no simulation time yet.
  void step(double time_s, bool known = true) { step(at_s(time_s), at_s(time_s), known); }
  void step(SimTime sim, SimTime steady, bool known = true) {
    drain();
    for (int turn = 0; turn < 1000; ++turn) {
      node_.step({known ? sim : SimTime(), steady, known});
      drain();
      const bus::Due due = node_.due();
      const bool again = due.steady <= steady || due.sim == SimTime::at_once() || (known && due.sim <= sim);
      if (!again) return;
    }
    ADD_FAILURE() << "the node keeps itself busy";
  }
  // As a runner does: from instant to instant at which the node is due, up to and with `end_s`.
  void run_to(double end_s) {
    for (;;) {
      drain();
      const bus::Due due = node_.due();
      const SimTime next = std::max(std::min(due.sim, due.steady), now_);
      if (next > at_s(end_s)) break;
      now_ = next;
      step(now_, now_);
    }
    now_ = at_s(end_s);
  }
  void drain() {
    while (lcm_.handleTimeout(0) > 0) continue;
  }

  // Rows of the last table of a vehicle; fails the test when there is none.
  const link_table_t& last_table(VehicleId id) const {
    for (auto table = links.rbegin(); table != links.rend(); ++table) {
      if (table->message.vehicle_id == id) return table->message;
    }
    throw std::runtime_error("no table of vehicle " + std::to_string(id));
  }

  std::vector<ReceivedOn<link_table_t>> links;
  std::vector<ReceivedOn<modem_receipt_t>> receipts;
  std::vector<ReceivedOn<modem_receive_t>> receives;
  std::vector<ReceivedOn<modem_event_t>> events;
  std::vector<ReceivedOn<link_reply_t>> replies;
  std::vector<ReceivedOn<node_status_t>> statuses;
  std::vector<packet_outcome_t> outcomes;
  std::vector<environment_t> environments;

 private:
  template <class Message>
  void record(const bus::Family& family, std::vector<ReceivedOn<Message>>& into) {
    bus_.subscribe<Message>(family, [&into, family](std::string_view name, const Message& message) {
      into.push_back({family.of(name), message});
    });
  }

  lcm::LCM lcm_;
  ChannelServerNode node_;
  bus::Bus bus_;
  SimTime now_;
};

}  // namespace halocline::channel_server::testing
