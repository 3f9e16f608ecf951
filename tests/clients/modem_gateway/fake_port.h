// SPDX-License-Identifier: BSD-3-Clause
// A protocol's port that records what the protocol does, and the modem's answers made by hand.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "clients/modem/modem_client.h"
#include "clients/modem_gateway/protocols/address_book.h"
#include "clients/modem_gateway/protocols/fields.h"
#include "clients/modem_gateway/protocols/interface_options.h"
#include "clients/modem_gateway/protocols/protocol.h"
#include "clients/modem_gateway/protocols/protocols.h"
#include "clients/modem_gateway/protocols/sound_field.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway::testing {

// What follows these bytes in every payload of the conformance tests: all that a framing may trip over.
inline constexpr std::string_view kHardBytes{"\x00\x0A\x0D\x2B\x2C\xFF", 6};

class FakePort : public ProtocolPort {
 public:
  struct Sent {
    SimTime start;
    std::int32_t destination;
    std::string payload;
    clients::SendOptions options;
    std::int64_t sequence;
  };
  static constexpr std::int64_t kSession = 77;

  SimTime now() const override { return at; }
  SimTime clock_at(SimTime time) const override { return time + clock_ahead; }
  void sleep_until(SimTime wakes) override { sleeps_until = wakes; }
  void write(ClientId client, std::string_view bytes) override {
    written += bytes;
    written_to.push_back(client);
  }
  void send_datagram(ClientId, std::uint16_t to, std::string_view b) override {
    datagrams.emplace_back(to, b);
  }
  void disconnect(ClientId client) override { disconnected.push_back(client); }
  std::int64_t send(StartRule start, std::int32_t destination, std::span<const std::uint8_t> payload,
                    clients::SendOptions options) override {
    const auto sequence = static_cast<std::int64_t>(sent.size());
    sent.push_back({start(), destination, std::string(as_text(payload)), std::move(options), sequence});
    return sequence;
  }
  std::size_t unsent() const override { return unsent_packets; }
  bool is_own(std::int64_t send_session) const override { return send_session == kSession; }
  const vehicle_sensors_t* sensors() const override { return measured ? &*measured : nullptr; }
  const vehicle_state_t* state() const override { return place ? &*place : nullptr; }
  const vehicle_battery_t* battery() const override { return charge ? &*charge : nullptr; }
  bool ask_paths(std::int32_t from_vehicle) override {
    paths_asked.push_back(from_vehicle);
    return true;
  }
  void note(std::string_view, std::string_view) override {}
  // What was written since the last call.
  std::string take() {
    written_to.clear();
    return std::exchange(written, "");
  }

  SimTime at = SimTime::from_seconds(100);
  SimDuration clock_ahead;  // of the vehicle's clock
  SimTime sleeps_until;
  std::string written;
  std::vector<ClientId> written_to, disconnected;
  std::size_t unsent_packets = 0;
  std::vector<Sent> sent;
  std::vector<std::pair<std::uint16_t, std::string>> datagrams;
  std::optional<vehicle_sensors_t> measured;
  std::optional<vehicle_state_t> place;
  std::optional<vehicle_battery_t> charge;
  std::vector<std::int32_t> paths_asked;
};

// The modem interface of vehicle 1, and messages for it.
class ProtocolBench {
 public:
  static constexpr std::int32_t kVehicle = 1;
  static constexpr ClientId kHost = 5;

  explicit ProtocolBench(std::string_view kind, std::string_view options = "", SoundField* sound = nullptr)
      : protocol(
            make_protocol(kind, {port, addresses, kVehicle, InterfaceOptions(options), {}, 0, 0, sound})) {
    protocol->on_opened(kHost);
    port.take();
  }

  // What the modem interface answers at once.
  std::string ask(std::string_view bytes) {
    protocol->on_bytes(kHost, bytes);
    return port.take();
  }
  std::string ask_in_pieces(std::string_view bytes) {
    for (const char byte : bytes) protocol->on_bytes(kHost, std::string_view(&byte, 1));
    return port.take();
  }

  // What it writes until `seconds` have passed.
  std::string wait(double seconds) {
    const SimTime end = port.at + SimDuration::from_seconds(seconds);
    while (protocol->next() <= end) {
      port.at = std::max(port.at, protocol->next());
      protocol->step();
    }
    port.at = end;
    return port.take();
  }

  // The receipt of the last packet sent.
  std::string accept(double duration_s = 0.5, double starts_in_s = 0) {
    modem_receipt_t receipt{};
    receipt.utime = port.at.to_utime();
    receipt.send_session = FakePort::kSession;
    receipt.packet_sequence = port.sent.back().sequence;
    receipt.start_utime =
        (std::max(port.at, port.sent.back().start) + SimDuration::from_seconds(starts_in_s)).to_utime();
    receipt.duration_s = duration_s;
    protocol->on_receipt(receipt);
    return port.take();
  }
  std::string refuse(std::int8_t result) {
    modem_receipt_t receipt{};
    receipt.utime = port.at.to_utime();
    receipt.send_session = FakePort::kSession;
    receipt.packet_sequence = port.sent.back().sequence;
    receipt.receipt_result = result;
    protocol->on_receipt(receipt);
    return port.take();
  }
  std::string receive(const modem_receive_t& packet) {
    protocol->on_packet(packet);
    return port.take();
  }
  std::string lose(const packet_outcome_t& outcome) {
    protocol->on_loss(outcome);
    return port.take();
  }

  // A packet from another vehicle that arrives now, all of it right.
  modem_receive_t packet_from(std::int32_t source, std::int32_t destination, std::string_view payload,
                              std::int8_t kind = modem_receive_t::DATA) const {
    modem_receive_t packet{};
    packet.utime = port.at.to_utime();
    packet.send_session = 1000 + source;
    packet.source_id = source;
    packet.destination_id = destination;
    packet.receiver_id = kVehicle;
    packet.packet_kind = kind;
    packet.duration_s = 0.25;
    packet.arrival_utime = packet.utime - 250'000;
    packet.received_level_db = 120;
    packet.noise_level_db = 90;
    packet.snr_db = 30;
    packet.sinr_db = 20;
    packet.snr_out_db = 25;
    packet.mse_db = -20;
    packet.strongest_path_doppler_factor = 1.0004;
    packet.payload = as_bytes(payload);
    packet.payload_size = static_cast<std::int32_t>(payload.size());
    packet.num_frames = 1;
    packet.frame_bytes = {packet.payload_size};
    packet.frames_good = 1;
    return packet;
  }
  // The answer of `source` to the last packet sent: a PING_REPLY or an ACK.
  modem_receive_t answer_from(std::int32_t source, std::int8_t kind, double two_way_s,
                              std::string_view payload = "") const {
    modem_receive_t packet = packet_from(source, kVehicle, payload, kind);
    packet.send_session = FakePort::kSession;
    packet.packet_sequence = port.sent.back().sequence;
    packet.two_way_travel_time_s = two_way_s;
    return packet;
  }

  FakePort port;
  AddressBook addresses;
  std::unique_ptr<Protocol> protocol;
};

}  // namespace halocline::modem_gateway::testing
