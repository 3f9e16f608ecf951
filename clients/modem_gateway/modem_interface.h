// SPDX-License-Identifier: BSD-3-Clause
// Emulated modem interface: connects one simulated modem to the hosts that speak the protocol of a real one.
//
// Messages of the bus are stored as they arrive and handed to the protocol in the node's step, in their
// order. A packet that was detected and then lost is reported once both its MODEM_EVENT and its OUTCOME have
// arrived; the channel server publishes them one after the other.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "bus/bus.h"
#include "bus/runtime/node.h"
#include "clients/modem/modem_client.h"
#include "clients/modem_gateway/gateway_config.h"
#include "clients/modem_gateway/protocols/address_book.h"
#include "clients/modem_gateway/protocols/protocol.h"
#include "clients/modem_gateway/protocols/sound_field.h"
#include "clients/modem_gateway/send_queue.h"
#include "clients/onboard/clocks/vehicle_time.h"
#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {

class ModemInterface : private ProtocolPort {
 public:
  // Writes bytes to a host of this modem interface, or to all (by way of Connections).
  using Writer = std::function<void(ClientId client, std::string_view bytes)>;
  using DatagramWriter = std::function<void(ClientId client, std::uint16_t port, std::string_view bytes)>;
  using Disconnect = std::function<void(ClientId client)>;
  // Records everything that passes, for debugging: `direction` is '<' from a host, '>' to a host, '*' from
  // the bus. May be empty.
  using Trace = std::function<void(char direction, std::string_view text)>;

  // Subscribes on the bus. `clocks` must outlive it, and so must `sound`, which may be null for a kind that
  // needs none. Throws InvalidArgument for an invalid configuration.
  ModemInterface(bus::Bus& bus, const ModemInterfaceConfig& config, const GatewayConfig& gateway,
                 const clients::VehicleTime& clocks, AddressBook& addresses, SoundField* sound, Writer writer,
                 DatagramWriter datagram_writer, Disconnect disconnect, Trace trace);

  const std::string& vehicle() const { return modem_.address().vehicle; }
  std::int32_t vehicle_id() const { return modem_.address().vehicle_id; }

  void store(const packet_outcome_t& outcome);
  bool wants_outcomes() const { return listens_.has_value(); }

  // The parts of a step of the node, called in this order: deliver what came from the bus, deliver what hosts
  // did, and do what is due.
  void begin_step(const bus::Now& now);
  void on_opened(ClientId client);
  void on_bytes(ClientId client, std::string_view bytes);
  void on_closed(ClientId client);
  void end_step();

  bus::Due due() const;
  // Starts again for another run: messages of the previous run are discarded, and the modem is as the
  // scenario configures it.
  void restart();

  // Saves or loads what the next incarnation of the process continues from: the modem's non-volatile memory
  // and its packet numbers. Loading throws InvalidArgument for what another modem interface saved.
  void archive(Archive& a);
  // Returns true when the modem's non-volatile memory has changed since the last call.
  bool take_stored();

  const clients::ModemCounters& counters() const { return modem_.counters(); }
  std::int64_t losses() const { return losses_; }

 private:
  using Happening = std::variant<modem_receipt_t, modem_receive_t, modem_event_t, packet_outcome_t,
                                 vehicle_usbl_t, link_reply_t>;

  SimTime now() const override { return now_.sim; }
  SimTime clock_at(SimTime time) const override { return clocks_.shown(vehicle_id(), time); }
  void sleep_until(SimTime wakes) override;
  void write(ClientId client, std::string_view bytes) override;
  void send_datagram(ClientId client, std::uint16_t port, std::string_view bytes) override {
    datagram_writer_(client, port, bytes);
  }
  void disconnect(ClientId client) override { disconnect_(client); }
  std::int64_t send(StartRule start, std::int32_t destination, std::span<const std::uint8_t> payload,
                    clients::SendOptions options) override;
  std::size_t unsent() const override { return queue_.size(); }
  bool is_own(std::int64_t send_session) const override { return send_session == modem_.address().session; }
  const vehicle_sensors_t* sensors() const override { return sensors_ ? &*sensors_ : nullptr; }
  const vehicle_state_t* state() const override { return state_ ? &*state_ : nullptr; }
  const vehicle_battery_t* battery() const override { return battery_ ? &*battery_ : nullptr; }
  bool ask_paths(std::int32_t from_vehicle) override;
  void note(std::string_view event, std::string_view details) override;

  void trace(char direction, std::string_view text) const {
    if (trace_) trace_(direction, text);
  }
  // Replaces the packet number of an own packet by the number that send() returned for it.
  template <class Message>
  Message numbered(Message message) const {
    if (is_own(message.send_session)) message.packet_sequence = queue_.number_of(message.packet_sequence);
    return message;
  }
  void make_modem();
  void send_due();
  void hand_over(const Happening& happening);
  void hand_over_receipt(const modem_receipt_t& receipt);
  void pair_losses();

  bus::Bus& bus_;
  const clients::VehicleTime& clocks_;
  Writer writer_;
  DatagramWriter datagram_writer_;
  Disconnect disconnect_;
  Trace trace_;
  clients::ModemClient modem_;
  SendQueue queue_;
  std::function<std::unique_ptr<Protocol>()> make_protocol_;
  std::unique_ptr<Protocol> protocol_;
  std::int64_t stored_changes_ = 0;
  std::set<ClientId> hosts_;
  std::optional<clients::ListenOptions> listens_;
  SimTime next_listen_;
  bus::Now now_;
  std::deque<Happening> happenings_;
  std::deque<modem_event_t> lost_events_;       // losses whose outcome has not arrived
  std::deque<packet_outcome_t> lost_outcomes_;  // losses whose event has not arrived, if one comes at all
  std::optional<vehicle_sensors_t> sensors_;
  std::optional<vehicle_state_t> state_;
  std::optional<vehicle_battery_t> battery_;
  std::vector<NamedVehicle> vehicles_;
  std::string client_name_;  // client name of link queries
  std::int64_t queries_ = 0;
  std::int64_t losses_ = 0;
  std::map<std::string, std::int64_t> noted_;  // number of reports by name of the event
};

}  // namespace halocline::modem_gateway
