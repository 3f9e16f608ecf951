// What every modem protocol of the gateway is: a state machine between the bytes of a host and the happenings of one modem.
//
// Pure: bytes and messages of the bus come in by calls, bytes and packets go out through a ProtocolPort, the time is given. So a protocol
// is tested without sockets and without a simulator. It is told everything in the order in which it happened, and never calls back into
// a call of its own: what a send() leads to comes later.
//
// A protocol of one's own: docs/modem_gateway.md.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "bus/messages.h"
#include "clients/modem/modem_client.h"
#include "clients/modem_gateway/protocols/address_book.h"
#include "clients/modem_gateway/protocols/door_options.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {

// A host that is connected to a door; each connection has a number of its own, from 1.
using ClientId = std::int64_t;
inline constexpr ClientId kAllClients = 0;

// What a protocol may do, and look at.
class ProtocolPort {
 public:
  virtual ~ProtocolPort() = default;

  // The instant of the present call, simulation time.
  virtual SimTime now() const = 0;
  // To one host, or to all that are connected. What does not fit into the buffer of a host that does not read is dropped whole.
  virtual void write(ClientId client, std::string_view bytes) = 0;
  // Sends a packet at `start`, or now where that has passed; returns its packet_sequence, which its receipt, events and answers bear.
  // `payload` and `options`: as ModemClient::send, which throws InvalidArgument for what no modem sends.
  virtual std::int64_t send(SimTime start, std::int32_t destination, std::span<const std::uint8_t> payload,
                            clients::SendOptions options) = 0;
  // Whether (session, packet_sequence) names a packet of this door.
  virtual bool is_own(std::int64_t send_session) const = 0;
  // The latest measurement of the vehicle's sensors; null before the first.
  virtual const vehicle_sensors_t* sensors() const = 0;
  // The latest state of the vehicle; null before the first.
  virtual const vehicle_state_t* state() const = 0;
  // For a person who watches: what a host did that is no protocol of this modem.
  virtual void note(std::string_view event, std::string_view details) = 0;
};

// Of the door that a protocol is made for.
struct ProtocolContext {
  ProtocolPort& port;
  AddressBook& addresses;  // of all doors of this kind
  std::int32_t vehicle_id;
  DoorOptions options;
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

  // The answer to a send(): accepted with start and duration, or refused.
  virtual void on_receipt(const modem_receipt_t& /*receipt*/) {}
  // A packet received, whole or in part; answers to own packets among them.
  virtual void on_packet(const modem_receive_t& /*packet*/) {}
  // An own transmission began or ended, a packet was detected, carrier; only with listening()->events.
  virtual void on_event(const modem_event_t& /*event*/) {}
  // A packet that had been detected was lost; only with listening()->events. One call for one OUTCOME.
  virtual void on_loss(const packet_outcome_t& /*outcome*/) {}
  // The vehicle's USBL measured where a packet came from; after its on_packet().
  virtual void on_bearing(const vehicle_usbl_t& /*bearing*/) {}

  // When step() is due by simulation time.
  virtual SimTime next() const { return SimTime::never(); }
  virtual void step() {}
};

}  // namespace halocline::modem_gateway
