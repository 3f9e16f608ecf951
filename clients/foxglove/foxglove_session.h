// SPDX-License-Identifier: BSD-3-Clause
// One connection by Foxglove's WebSocket protocol (foxglove.websocket.v1): channels are advertised, those
// that the client subscribes to are sent. Of a bus the newest; a log plays from its beginning at its own
// pace.
//
//   github.com/foxglove/ws-protocol, "Foxglove WebSocket Protocol Specification"
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "clients/mission/mission_store.h"
#include "core/sim_time.h"

namespace halocline::clients {

class FoxgloveSession {
 public:
  using Outbox = std::function<void(std::string message, bool binary)>;
  static constexpr double kPeriod_s = 0.1;

  FoxgloveSession(const std::string& name, Outbox outbox);

  // What is due at an instant of the mission; nothing unless `idle`: the connection has sent everything.
  void tick(double steady_s, bool idle, const MissionStore& mission, SimTime at);
  // A message of the client; what is no request of the protocol is answered by a status.
  void take(std::string_view message);

 private:
  void advertise_vehicles(const MissionStore& mission);
  void advertise(const std::string& topic, std::string_view schema, std::string_view json_schema);
  void send_data(std::uint32_t channel, SimTime at, const nlohmann::json& message);
  void send_outcomes(const MissionStore& mission, SimTime at);
  bool is_subscribed(std::uint32_t channel) const;

  Outbox outbox_;
  double sent_s_ = -kPeriod_s;
  std::uint32_t last_channel_ = 0;
  std::map<std::size_t, std::uint32_t> fixes_;         // channel of a vehicle's position, by its index
  std::map<std::uint32_t, std::uint32_t> subscribed_;  // channel by subscription

  SimTime outcomes_until_ = SimTime::at_once();
};

}  // namespace halocline::clients
