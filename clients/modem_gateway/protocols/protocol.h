// SPDX-License-Identifier: BSD-3-Clause
// What every modem protocol of the gateway is: a state machine between the bytes of a host and the happenings
// of one modem.
//
// Pure: bytes and messages of the bus come in by calls, bytes and packets go out through a ProtocolPort, the
// time is given. So a protocol is tested without sockets and without a simulator. It is told everything in
// the order in which it happened, and never calls back into a call of its own: what a send() leads to comes
// later.
//
// A protocol of one's own: docs/modem_gateway.md.
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

#include "bus/messages.h"
#include "clients/modem/modem_client.h"
#include "clients/modem_gateway/protocols/address_book.h"
#include "clients/modem_gateway/protocols/door_options.h"
#include "clients/modem_gateway/protocols/sound_field.h"
#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {

// A host that is connected to a door; each connection has a number of its own, from 1.
using ClientId = std::int64_t;
inline constexpr ClientId kAllClients = 0;

// In the place of a packet_sequence: a packet that was never sent, and one that a modem's earlier incarnation
// sent.
inline constexpr std::int64_t kNotSent = -1, kForgotten = -2;
// The channel server refuses transmissions that are further ahead than ten seconds.
inline constexpr SimDuration kMaxAhead = SimDuration::from_milliseconds(9000);

// What a protocol may do, and look at.
class ProtocolPort {
 public:
  virtual ~ProtocolPort() = default;

  // The instant of the present call, simulation time.
  virtual SimTime now() const = 0;
  // What the vehicle's own clock shows at an instant (docs/vehicles.md).
  virtual SimTime clock_at(SimTime time) const = 0;
  // The instant at which it shows that.
  SimTime instant_of(SimTime reading) const;
  // To one host, or to all that are connected. What does not fit into the buffer of a host that does not read
  // is dropped whole.
  virtual void write(ClientId client, std::string_view bytes) = 0;
  // By UDP, to a port of the machine that a host is on.
  virtual void send_datagram(ClientId /*client*/, std::uint16_t /*port*/, std::string_view /*bytes*/) {}
  // Ends the connection of a host that cannot be answered otherwise; a serial line stays.
  virtual void disconnect(ClientId client) = 0;
  // Earliest start of a packet: asked when its turn has come.
  using StartRule = std::function<SimTime()>;
  // Most packets that wait for their turn or sound, as many as a modem's own queue holds (docs/packets.md).
  static constexpr std::size_t kMaxUnsent = 16;

  // Takes a packet to be sent: packets go out one after the other, each at `start` or later, and again where
  // the modem was busy with an answer of its own. Returns the number that its receipt, events and answers
  // bear as packet_sequence. One on_receipt() follows, a refusal also where the channel server never
  // answered. `payload` and `options`: as ModemClient::send. kNotSent, and no receipt, for what no modem
  // sends and beyond kMaxUnsent.
  virtual std::int64_t send(StartRule start, std::int32_t destination, std::span<const std::uint8_t> payload,
                            clients::SendOptions options) = 0;
  std::int64_t send(SimTime start, std::int32_t destination, std::span<const std::uint8_t> payload,
                    clients::SendOptions options) {
    return send([start] { return start; }, destination, payload, std::move(options));
  }
  // Number of packets given to send() whose sound has not ended.
  virtual std::size_t unsent() const = 0;
  // From now on the modem acquires nothing, until that instant.
  virtual void sleep_until(SimTime wakes) = 0;
  // Whether (session, packet_sequence) names a packet of this door.
  virtual bool is_own(std::int64_t send_session) const = 0;
  // The latest measurement of the vehicle's sensors; null before the first.
  virtual const vehicle_sensors_t* sensors() const = 0;
  // The latest state of the vehicle, and of its battery where it has one; null before the first.
  virtual const vehicle_state_t* state() const = 0;
  virtual const vehicle_battery_t* battery() const = 0;
  // Asks for the paths of sound from a vehicle to this one, as they are now: on_paths(). False for a vehicle
  // that is not known.
  virtual bool ask_paths(std::int32_t from_vehicle) = 0;
  // For a person who watches: what a host did that is no protocol of this modem.
  virtual void note(std::string_view event, std::string_view details) = 0;
};

// Of the door that a protocol is made for.
struct ProtocolContext {
  ProtocolPort& port;
  AddressBook& addresses;  // of all doors of this kind
  std::int32_t vehicle_id;
  DoorOptions options;
  std::vector<NamedVehicle> vehicles = {};  // of the scenario
  double origin_latitude_deg = 0, origin_longitude_deg = 0;
  SoundField* sound = nullptr;  // never null where needs_sound(kind), but while options are checked alone

  // The door's own; empty for a vehicle that is not among them.
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

  // How the modem is to listen; none where its own way serves.
  virtual std::optional<clients::ListenOptions> listening() const { return std::nullopt; }

  virtual void on_opened(ClientId /*client*/) {}
  // Bytes in any pieces, at most 16 KiB a call.
  virtual void on_bytes(ClientId client, std::string_view bytes) = 0;
  virtual void on_closed(ClientId /*client*/) {}

  // The answer to a send(): accepted with start and duration, or refused. A host whose command was confirmed
  // is told of a refusal.
  virtual void on_receipt(const modem_receipt_t& /*receipt*/) {}
  // A packet received, whole or in part; answers to own packets among them.
  virtual void on_packet(const modem_receive_t& /*packet*/) {}
  // An own transmission began or ended, a packet was detected, carrier; only with listening()->events.
  virtual void on_event(const modem_event_t& /*event*/) {}
  // A packet that had been detected was lost; only with listening()->events. One call for one OUTCOME.
  virtual void on_loss(const packet_outcome_t& /*outcome*/) {}
  // The vehicle's USBL measured where a packet came from; after its on_packet().
  virtual void on_bearing(const vehicle_usbl_t& /*bearing*/) {}

  // What ask_paths() led to.
  virtual void on_paths(const link_reply_t& /*reply*/) {}

  // Vehicles that its options name as transponders.
  virtual std::vector<std::int32_t> transponders() const { return {}; }

  // When step() is due by simulation time.
  virtual SimTime next() const { return SimTime::never(); }
  virtual void step() {}

  // The modem's non-volatile memory: settings that outlive the process. A factory reset clears it, a new run
  // begins without.
  virtual void archive(Archive& /*a*/) {}
  // Increases with each change of that memory.
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
