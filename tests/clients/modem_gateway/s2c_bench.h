// SPDX-License-Identifier: BSD-3-Clause
// An emulated EvoLogics modem, and messages that arrive at it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "clients/modem_gateway/protocols/s2c/s2c_core.h"
#include "tests/clients/modem_gateway/fake_port.h"

namespace halocline::modem_gateway::testing {

struct S2cBench : ProtocolBench {
  explicit S2cBench(std::string_view options = "") : ProtocolBench("evologics", options) {}
  std::string say(const std::string& command) { return ask(command + "\n"); }
  // A plain message that arrives now.
  modem_receive_t message_from(std::int32_t source, std::int32_t destination, std::string_view data,
                               std::int32_t rate = kS2cImRate) const {
    modem_receive_t packet = packet_from(source, destination, data);
    packet.stamped = true;
    packet.rate_number = rate;
    packet.travel_time_s = 0.4;
    return packet;
  }
  modem_receive_t message_of_kind(S2cKind kind, std::string_view data, std::int32_t rate = kS2cImRate) const {
    modem_receive_t packet = message_from(5, 1, data, rate);
    packet.header_number = S2cPayload{kind, 0, {}}.header_number();
    return packet;
  }
};
// 0.25 s, 120 dB, SINR 20 dB, Doppler factor 1.0004 at 1500 m/s.
inline constexpr auto kQuality = "250000,-70,160,0.6000,";

}  // namespace halocline::modem_gateway::testing
