// SPDX-License-Identifier: BSD-3-Clause
// Connection of a Foxglove client by the WebSocket protocol foxglove.websocket.v1: channels are advertised,
// and those to which the client subscribes are sent. A bus is shown at its newest time; a log is played from
// its beginning in real time.
//
// Source: github.com/foxglove/ws-protocol, "Foxglove WebSocket Protocol Specification".
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "core/sim_time.h"
#include "runs/timeline/run_timeline.h"

namespace halocline::clients {

class FoxgloveSession {
 public:
  using Outbox = std::function<void(std::string message, bool binary)>;
  static constexpr double kPeriod_s = 0.1;

  FoxgloveSession(const std::string& name, Outbox outbox);

  // Sends what is due at one time of the run, but only when `idle`, that is when the connection has sent
  // everything before.
  void tick(double steady_s, bool idle, const RunTimeline& timeline, SimTime at);
  // Takes a message of the client; anything but a request of the protocol is answered by a status.
  void take(std::string_view message);

 private:
  void advertise_vehicles(const RunTimeline& timeline);
  void advertise(const std::string& topic, std::string_view schema, std::string_view json_schema);
  void send_data(std::uint32_t channel, SimTime at, const nlohmann::json& message);
  void send_outcomes(const RunTimeline& timeline, SimTime at);
  bool is_subscribed(std::uint32_t channel) const;

  Outbox outbox_;
  double sent_s_ = -kPeriod_s;
  std::uint32_t last_channel_ = 0;
  std::map<std::size_t, std::uint32_t> fixes_;         // channel of a vehicle's position; key: index
  std::map<std::uint32_t, std::uint32_t> subscribed_;  // channel; key: subscription

  SimTime outcomes_until_ = SimTime::at_once();
};

}  // namespace halocline::clients
