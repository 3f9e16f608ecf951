// SPDX-License-Identifier: BSD-3-Clause
// A modem for simple programs: calls that wait. One lcm::LCM, no node, no loop of one's own.
//
//   const auto lcm = bus::open_transport(bus::effective_url(""));
//   BlockingModem modem(*lcm, {.vehicle = "auv-1", .vehicle_id = 1, .session = my_session});
//   const auto sequence = modem.send(kBroadcastId, payload);
//   if (sequence && modem.wait_receipt(*sequence, SimDuration::from_seconds(2))) { ... }
//   while (const auto packet = modem.wait_receive(SimDuration::from_seconds(60))) { ... }
//   if (modem.listen({.events = true})) { const auto event = modem.wait_event(SimDuration::from_seconds(60));
//   ... }
//
// Time-outs are of steady (wall) time. While a call waits, everything on the LCM is dispatched, so other
// subscriptions made on it are served too. Not thread-safe; the LCM must outlive the modem.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <span>

#include "bus/runtime/time_source.h"
#include "clients/modem/modem_client.h"
#include "core/sim_time.h"

namespace halocline::clients {

class BlockingModem {
 public:
  BlockingModem(lcm::LCM& lcm, const ModemAddress& address, ResendPolicy policy = {});

  // Returns the simulation time according to the conductor's CLOCK. Waits for the first CLOCK up to
  // `timeout`; nothing when none arrived.
  [[nodiscard]] std::optional<SimTime> sim_now(SimDuration timeout);

  // Sends at simulation time `start`, or now, and returns the packet_sequence at once. send() returns nothing
  // when no CLOCK arrives within a second. Throws as ModemClient::send.
  std::int64_t send_at(SimTime start, std::int32_t destination, std::span<const std::uint8_t> payload,
                       SendOptions options = {});
  [[nodiscard]] std::optional<std::int64_t> send(std::int32_t destination,
                                                 std::span<const std::uint8_t> payload,
                                                 SendOptions options = {});
  // Sends a PING and waits for its answer: returns the two-way travel time, s; nothing after `timeout`.
  // Packets that arrive meanwhile are kept for wait_receive().
  [[nodiscard]] std::optional<double> ping(std::int32_t destination, SimDuration timeout);

  // Sends a packet with acknowledgement and waits for it. Bit i of the result is 1 when frame i was received
  // correctly; nothing after `timeout`. Other packets that arrive meanwhile are kept for wait_receive().
  [[nodiscard]] std::optional<std::uint32_t> send_acknowledged(std::int32_t destination,
                                                               std::span<const std::uint8_t> payload,
                                                               SimDuration timeout, SendOptions options = {});

  // Waits for the packet's receipt, repeating the SEND meanwhile; nothing after `timeout`.
  [[nodiscard]] std::optional<modem_receipt_t> wait_receipt(std::int64_t packet_sequence,
                                                            SimDuration timeout);
  // Waits for a packet to arrive; nothing after `timeout`. A timeout of 0 returns a packet that has already
  // arrived.
  [[nodiscard]] std::optional<modem_receive_t> wait_receive(SimDuration timeout);

  // Sets how the modem listens from now on (ModemClient::listen); with `events`, wait_event() returns what it
  // reports. Returns false, and publishes nothing, when no CLOCK arrives within a second. Throws as
  // ModemClient::listen.
  bool listen(const ListenOptions& options);
  // Waits for an event of the modem; nothing after `timeout`. Of more than ModemClient::kMaxWaiting events
  // the oldest are discarded.
  [[nodiscard]] std::optional<modem_event_t> wait_event(SimDuration timeout);

  const ModemClient& client() const { return client_; }

 private:
  // Dispatches messages until `done` returns true, or until `timeout`.
  void wait(SimDuration timeout, const std::function<bool()>& done);

  lcm::LCM& lcm_;
  bus::Bus bus_;
  bus::ConductorTime time_;
  ModemClient client_;
  std::deque<modem_event_t> events_;  // not taken yet
};

}  // namespace halocline::clients
