// SPDX-License-Identifier: BSD-3-Clause
// The channel server's side of one modem, as far as a client sees it: what it receives, and answers made by
// hand.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bus/bus.h"

namespace halocline::clients::testing {

class FakeServer {
 public:
  FakeServer(lcm::LCM& lcm, const std::string& vehicle) : bus_(lcm, {"fake-server", 99}), vehicle_(vehicle) {
    bus_.subscribe<modem_send_t>(bus::channels::kSend.of(vehicle), [this](const modem_send_t& message) {
      sends.push_back(message);
      if (answers) accept(message);
    });
  }

  bus::Bus& bus() { return bus_; }

  void accept(const modem_send_t& message) { answer(message, modem_receipt_t::ACCEPTED); }

  void answer(const modem_send_t& message, std::int8_t result) {
    modem_receipt_t receipt{};
    receipt.utime = message.utime;
    receipt.session = 99;
    receipt.sequence = sequence_++;
    receipt.send_session = message.session;
    receipt.packet_sequence = message.packet_sequence;
    receipt.receipt_result = result;
    if (result == modem_receipt_t::ACCEPTED) {
      receipt.start_utime = message.utime;
      receipt.duration_s = 0.5;
    }
    bus_.publish(bus::channels::kReceipt.of(vehicle_), receipt);
  }

  void deliver(std::int64_t send_session, std::int32_t source, std::int64_t packet_sequence) {
    modem_receive_t packet{};
    packet.utime = 1'000'000;
    packet.session = 99;
    packet.sequence = sequence_++;
    packet.send_session = send_session;
    packet.packet_sequence = packet_sequence;
    packet.source_id = source;
    packet.destination_id = 1;
    packet.receiver_id = 1;
    packet.travel_time_s = 0.66;
    packet.payload_size = 1;
    packet.payload = {static_cast<std::uint8_t>(packet_sequence)};
    bus_.publish(bus::channels::kReceive.of(vehicle_), packet);
  }

  // The answer of `replier` to the ping of that name.
  void reply_to_ping(const modem_send_t& ping, std::int32_t replier, double two_way_s) {
    modem_receive_t packet{};
    packet.session = 99;
    packet.sequence = sequence_++;
    packet.send_session = ping.session;
    packet.packet_sequence = ping.packet_sequence;
    packet.source_id = replier;
    packet.destination_id = packet.receiver_id = ping.source_id;
    packet.packet_kind = modem_receive_t::PING_REPLY;
    packet.two_way_travel_time_s = two_way_s;
    bus_.publish(bus::channels::kReceive.of(vehicle_), packet);
  }

  bool answers = false;  // whether each SEND is accepted on receipt
  std::vector<modem_send_t> sends;

 private:
  bus::Bus bus_;
  std::string vehicle_;
  std::int64_t sequence_ = 0;
};

}  // namespace halocline::clients::testing
