// SPDX-License-Identifier: BSD-3-Clause
// An emulated Micromodem and the sentences that it writes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "clients/modem_gateway/protocols/fields.h"
#include "clients/modem_gateway/protocols/micromodem/nmea.h"
#include "tests/clients/modem_gateway/fake_port.h"

namespace halocline::modem_gateway::testing {

// Bodies of the sentences in what it wrote; each must have its checksum and line end.
inline std::vector<std::string> bodies(const std::string& written) {
  std::vector<std::string> bodies;
  for (std::size_t begin = 0; begin < written.size();) {
    const std::size_t end = written.find("\r\n", begin);
    const std::string line = written.substr(begin, end - begin);
    EXPECT_NE(end, std::string::npos) << written;
    EXPECT_EQ(nmea_sentence(line).problem, NmeaSentence::Problem::kNone) << line;
    EXPECT_EQ(line[line.size() - 3], '*') << line;
    bodies.push_back(line.substr(1, line.rfind('*') - 1));
    begin = end == std::string::npos ? written.size() : end + 2;
  }
  return bodies;
}

// Fields after the id, from 1.
inline std::string field(const std::string& body, std::size_t number) {
  return std::string(fields_of(body, ',').at(number));
}

struct MicromodemBench : ProtocolBench {
  explicit MicromodemBench(std::string_view options = "") : ProtocolBench("micromodem", options) {}
  std::vector<std::string> say(const std::string& body) { return bodies(ask("$" + body + "\r\n")); }
  std::vector<std::string> hear(const modem_receive_t& packet) { return bodies(receive(packet)); }
  // A packet of that rate is detected.
  std::vector<std::string> detect(std::int32_t rate) {
    modem_event_t event{};
    event.modem_event = modem_event_t::PACKET_DETECTED;
    event.rate_number = rate;
    protocol->on_event(event);
    return bodies(port.take());
  }
  std::vector<std::string> after(double seconds) { return bodies(wait(seconds)); }
};
inline constexpr auto kFirstGeneration = "revision=0.94.0.00";

}  // namespace halocline::modem_gateway::testing
