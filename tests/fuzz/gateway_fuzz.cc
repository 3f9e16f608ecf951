// SPDX-License-Identifier: BSD-3-Clause
// A protocol of the modem gateway (HALOCLINE_FUZZ_PROTOCOL): what two hosts write, in pieces, between what
// happens to the modem and as time goes on.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bus/messages/message_codec.h"
#include "clients/modem/modem_client.h"
#include "clients/modem_gateway/protocols/address_book.h"
#include "clients/modem_gateway/protocols/interface_options.h"
#include "clients/modem_gateway/protocols/protocol.h"
#include "clients/modem_gateway/protocols/protocols.h"
#include "clients/modem_gateway/protocols/sound_field.h"
#include "core/check.h"
#include "core/sim_time.h"
#include "tests/fuzz/bus_message.h"
#include "tests/fuzz/fuzz_input.h"

namespace {

using namespace halocline;
using namespace halocline::modem_gateway;

constexpr std::int64_t kSession = 77;
constexpr std::int32_t kVehicle = 1;

class Port : public ProtocolPort {
 public:
  SimTime now() const override { return at; }
  SimTime clock_at(SimTime time) const override { return time + SimDuration::from_milliseconds(250); }
  void write(ClientId, std::string_view bytes) override { written += bytes.size(); }
  void disconnect(ClientId) override {}
  std::int64_t send(StartRule start, std::int32_t, std::span<const std::uint8_t>,
                    clients::SendOptions) override {
    started = std::max(at, start());
    return next_packet++;
  }
  // All counts of packets that wait come in turn.
  std::size_t unsent() const override { return static_cast<std::size_t>(next_packet % 20); }
  void sleep_until(SimTime) override {}
  bool is_own(std::int64_t send_session) const override { return send_session == kSession; }
  const vehicle_sensors_t* sensors() const override { return measured ? &*measured : nullptr; }
  const vehicle_state_t* state() const override { return place ? &*place : nullptr; }
  const vehicle_battery_t* battery() const override { return charge ? &*charge : nullptr; }
  bool ask_paths(std::int32_t) override { return true; }
  void note(std::string_view, std::string_view) override {}

  SimTime at = SimTime::from_seconds(100), started;
  std::int64_t next_packet = 0;
  std::size_t written = 0;
  std::optional<vehicle_sensors_t> measured;
  std::optional<vehicle_state_t> place;
  std::optional<vehicle_battery_t> charge;
};

// As a modem interface hands it over: what the bus refuses never comes.
template <class Message>
std::optional<Message> message_from(fuzz::Input& input) {
  return bus::decoded<Message>(fuzz::with_fingerprint(Message::getHash(), input.block()));
}

// In which nothing is heard.
class QuietSea : public SoundField {
 public:
  void emit(std::int32_t, SimTime, double, std::span<const float>) override {}
  void silence(std::int32_t, SimTime) override {}
  SimDuration lag() const override { return SimDuration::from_milliseconds(250); }
  std::vector<double> record(std::int32_t, double, std::int64_t, std::size_t count) override {
    return std::vector<double>(count);
  }
};

class ModemInterface {
 public:
  ModemInterface()
      : protocol_(make_protocol(HALOCLINE_FUZZ_PROTOCOL, {port_,
                                                          addresses_,
                                                          kVehicle,
                                                          InterfaceOptions(""),
                                                          {{"auv-1", kVehicle}, {"auv-2", 2}},
                                                          40,
                                                          -50,
                                                          &sea_})) {
    protocol_->on_opened(1);
    protocol_->on_opened(2);
  }

  void step(fuzz::Input& input) {
    switch (input.below(13)) {
      case 0:
      case 1:
        protocol_->on_bytes(1, input.text_block());
        break;
      case 2:
        protocol_->on_bytes(2, input.text_block());
        break;
      case 3:
        wait(SimDuration::from_milliseconds(20 * std::int64_t{input.number()}));
        break;
      case 4:
        receipt(input);
        break;
      case 5:
        own_event(input);
        break;
      case 6:
        packet(input);
        break;
      case 7:
        if (const auto m = message_from<modem_receive_t>(input)) protocol_->on_packet(*m);
        break;
      case 8:
        if (const auto m = message_from<modem_event_t>(input)) protocol_->on_event(*m);
        break;
      case 9:
        if (const auto m = message_from<packet_outcome_t>(input)) protocol_->on_loss(*m);
        break;
      case 10:
        if (const auto m = message_from<vehicle_usbl_t>(input)) protocol_->on_bearing(*m);
        break;
      case 11:
        if (const auto m = message_from<link_reply_t>(input)) protocol_->on_paths(*m);
        break;
      default:
        look(input);
    }
    ensure(port_.written < 64u << 20, "what is written is within bounds");
  }

 private:
  void wait(SimDuration duration) {
    const SimTime end = port_.at + duration;
    for (int steps = 0; protocol_->next() <= end; ++steps) {
      ensure(steps < 100'000, "a protocol does not keep itself busy");
      port_.at = std::max(port_.at, protocol_->next());
      protocol_->step();
    }
    port_.at = end;
  }

  // Of one of the latest four packets.
  std::int64_t packet_number(fuzz::Input& input) {
    return std::max<std::int64_t>(0, port_.next_packet - 1 - static_cast<std::int64_t>(input.below(4)));
  }

  void receipt(fuzz::Input& input) {
    modem_receipt_t receipt{};
    receipt.utime = port_.at.to_utime();
    receipt.send_session = kSession;
    receipt.packet_sequence = packet_number(input);
    receipt.receipt_result = static_cast<std::int8_t>(input.below(12));
    receipt.start_utime = port_.started.to_utime();
    receipt.duration_s = 0.01 * input.number();
    if (bus::problem_in(receipt).empty()) protocol_->on_receipt(receipt);
  }

  void own_event(fuzz::Input& input) {
    modem_event_t event{};
    event.utime = port_.at.to_utime();
    event.event_ns = port_.at.nanoseconds();
    event.modem_event = static_cast<std::int8_t>(input.below(8));
    event.send_session = kSession;
    event.packet_sequence = packet_number(input);
    if (bus::problem_in(event).empty()) protocol_->on_event(event);
  }

  void packet(fuzz::Input& input) {
    modem_receive_t packet{};
    packet.utime = port_.at.to_utime();
    packet.packet_kind = static_cast<std::int8_t>(input.below(8));
    const bool is_answer = input.below(2) == 1;
    packet.send_session = is_answer ? kSession : 1000;
    packet.packet_sequence = is_answer ? packet_number(input) : input.number();
    packet.source_id = input.number();
    packet.destination_id = input.number();
    packet.receiver_id = kVehicle;
    packet.duration_s = 0.25;
    packet.arrival_utime = packet.utime - 250'000;
    packet.two_way_travel_time_s = 0.01 * input.number();
    const auto payload = input.block();
    packet.payload.assign(payload.begin(), payload.end());
    packet.payload_size = static_cast<std::int32_t>(payload.size());
    packet.num_frames = 1;
    packet.frame_bytes = {packet.payload_size};
    packet.frames_good = static_cast<std::int32_t>(input.below(2));
    if (bus::problem_in(packet).empty()) protocol_->on_packet(packet);
  }

  void look(fuzz::Input& input) {
    switch (input.below(5)) {
      case 0:
        if (auto m = message_from<vehicle_sensors_t>(input)) port_.measured = std::move(m);
        break;
      case 1:
        if (auto m = message_from<vehicle_state_t>(input)) port_.place = std::move(m);
        break;
      case 2:
        if (auto m = message_from<vehicle_battery_t>(input)) port_.charge = std::move(m);
        break;
      case 3:
        protocol_->on_closed(2);
        protocol_->on_opened(2);
        break;
      default:
        addresses_.assign(1 + static_cast<std::int32_t>(input.below(4)), input.number());
    }
  }

  Port port_;
  QuietSea sea_;
  AddressBook addresses_;
  std::unique_ptr<Protocol> protocol_;
};

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  ModemInterface interface;
  while (!input.is_empty()) interface.step(input);
  return 0;
}
