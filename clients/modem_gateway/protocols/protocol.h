// SPDX-License-Identifier: BSD-3-Clause
// Interface of modem protocols: each is a state machine between the bytes of its hosts and the events of one
// modem.
//
// A protocol does no input or output of its own: bytes and messages of the bus come in by calls, bytes and
// packets go out through a ProtocolPort, and the time is given. It can be tested without sockets and without
// a simulator. It is told everything in the order in which it happened and is never re-entered: the
// consequences of a send() arrive in later calls.
//
// How to add a protocol: docs/interfaces.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bus/messages/messages.h"
#include "clients/modem/modem_client.h"
#include "clients/modem_gateway/protocols/address_book.h"
#include "clients/modem_gateway/protocols/interface_options.h"
#include "clients/modem_gateway/protocols/sound_field.h"
#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {

// Number of a host's connection; each connection has its own, from 1.
using ClientId = std::int64_t;
inline constexpr ClientId kAllClients = 0;

// Special values of packet_sequence: a packet that was never sent, and one that an earlier incarnation of the
// modem sent.
inline constexpr std::int64_t kNotSent = -1, kForgotten = -2;
// Furthest start of a transmission: the channel server refuses any more than ten seconds ahead.
inline constexpr SimDuration kMaxAhead = SimDuration::from_milliseconds(9000);

// Services that a protocol may use, and the state that it may read.
class ProtocolPort {
 public:
  virtual ~ProtocolPort() = default;

  // Returns the simulation time of the present call.
  virtual SimTime now() const = 0;
  // Returns the reading of the vehicle's own clock at a simulation time (docs/vehicles.md).
  virtual SimTime clock_at(SimTime time) const = 0;
  // Returns the simulation time at which the vehicle's clock has that reading.
  SimTime instant_of(SimTime reading) const;
  // Writes to one host, or to all that are connected. Bytes that do not fit into the buffer of a host that
  // does not read are dropped whole.
  virtual void write(ClientId client, std::string_view bytes) = 0;
  // Sends a UDP datagram to a port of the machine of a TCP host.
  virtual void send_datagram(ClientId /*client*/, std::uint16_t /*port*/, std::string_view /*bytes*/) {}
  // Ends the connection of a host that cannot be answered otherwise; a serial line stays open.
  virtual void disconnect(ClientId client) = 0;
  // Returns the earliest start of a packet; called when the packet's turn has come.
  using StartRule = std::function<SimTime()>;
  // Most packets that wait for their turn or are being transmitted, as many as a modem's own queue holds
  // (docs/packets.md).
  static constexpr std::size_t kMaxUnsent = 16;

  // Queues a packet. Packets are sent one after the other, each at `start` or later, and again if the modem
  // was busy with an answer of its own. Returns the number that its receipt, events and answers carry as
  // packet_sequence. One on_receipt() follows in any case: when the channel server never answers, it is a
  // refusal. `payload` and `options` are as in ModemClient::send. Returns kNotSent, with no receipt to
  // follow, for an impossible packet and beyond kMaxUnsent.
  virtual std::int64_t send(StartRule start, std::int32_t destination, std::span<const std::uint8_t> payload,
                            clients::SendOptions options) = 0;
  std::int64_t send(SimTime start, std::int32_t destination, std::span<const std::uint8_t> payload,
                    clients::SendOptions options) {
    return send([start] { return start; }, destination, payload, std::move(options));
  }
  // Returns the number of packets given to send() whose transmission has not ended.
  virtual std::size_t unsent() const = 0;
  // Lets the modem receive nothing until that time.
  virtual void sleep_until(SimTime wakes) = 0;
  // Returns true when the session of a packet is that of this modem's own packets.
  virtual bool is_own(std::int64_t send_session) const = 0;
  // Returns the latest measurement of the vehicle's sensors; null before the first.
  virtual const vehicle_sensors_t* sensors() const = 0;
  // Return the latest state of the vehicle, and of its battery if it has one; null before the first.
  virtual const vehicle_state_t* state() const = 0;
  virtual const vehicle_battery_t* battery() const = 0;
  // Requests the present sound paths from a vehicle to this one, which on_paths() receives. Returns false for
  // an unknown vehicle.
  virtual bool ask_paths(std::int32_t from_vehicle) = 0;
  // Logs, for an operator, that a host did something outside of this modem's protocol.
  virtual void note(std::string_view event, std::string_view details) = 0;
};

struct ProtocolContext {
  ProtocolPort& port;
  AddressBook& addresses;  // addresses of all modems of this kind
  std::int32_t vehicle_id;
  InterfaceOptions options;
  std::vector<NamedVehicle> vehicles = {};  // the vehicles of the scenario
  double origin_latitude_deg = 0, origin_longitude_deg = 0;
  SoundField* sound = nullptr;  // not null when needs_sound(kind), except while options alone are checked

  // Returns the name of the modem's vehicle; empty when it is not among `vehicles`.
  std::string vehicle_name() const {
    for (const NamedVehicle& vehicle : vehicles) {
      if (vehicle.id == vehicle_id) return vehicle.name;
    }
    return "";
  }
};

class Protocol {
 public:
  virtual ~Protocol() = default;

  // Returns how the modem is to listen; nothing for its default.
  virtual std::optional<clients::ListenOptions> listening() const { return std::nullopt; }

  virtual void on_opened(ClientId /*client*/) {}
  // Receives bytes of a host in arbitrary pieces, at most 16 KiB a call.
  virtual void on_bytes(ClientId client, std::string_view bytes) = 0;
  virtual void on_closed(ClientId /*client*/) {}

  // Receives the answer to a send(): accepted with start and duration, or refused. A host whose command was
  // already confirmed is told of a refusal.
  virtual void on_receipt(const modem_receipt_t& /*receipt*/) {}
  // Receives a packet, whole or in part; answers to own packets are among them.
  virtual void on_packet(const modem_receive_t& /*packet*/) {}
  // Reports that an own transmission began or ended, a packet was detected, or the carrier changed; only with
  // listening()->events.
  virtual void on_event(const modem_event_t& /*event*/) {}
  // Reports that a detected packet was lost; only with listening()->events. One call for each OUTCOME.
  virtual void on_loss(const packet_outcome_t& /*outcome*/) {}
  // Receives the direction that the vehicle's USBL measured to the source of a packet, after its on_packet().
  virtual void on_bearing(const vehicle_usbl_t& /*bearing*/) {}

  // Receives the reply to ask_paths().
  virtual void on_paths(const link_reply_t& /*reply*/) {}

  // Returns the vehicles that the options name as transponders.
  virtual std::vector<std::int32_t> transponders() const { return {}; }

  // Returns the simulation time at which step() is due.
  virtual SimTime next() const { return SimTime::never(); }
  virtual void step() {}

  // Saves or loads the modem's non-volatile memory: settings that outlive the process. A factory reset clears
  // it, and a new run begins without it.
  virtual void archive(Archive& /*a*/) {}
  // Returns a number that increases with each change of that memory.
  std::int64_t stored_changes() const { return stored_changes_; }

 protected:
  void note_stored() { ++stored_changes_; }

 private:
  std::int64_t stored_changes_ = 0;
};

inline bool is_accepted(const modem_receipt_t& receipt) {
  return receipt.receipt_result == modem_receipt_t::ACCEPTED ||
         receipt.receipt_result == modem_receipt_t::QUEUED;
}

}  // namespace halocline::modem_gateway
