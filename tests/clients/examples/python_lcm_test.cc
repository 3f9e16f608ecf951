// SPDX-License-Identifier: BSD-3-Clause
// clients/examples/python/lcm.py and LCM's own library understand each other: a Python program returns what
// it receives.
#include <chrono>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/support/process.h"

namespace halocline::testing {
namespace {

using namespace std::chrono_literals;
using Bytes = std::vector<std::uint8_t>;

constexpr const char* kUrl = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304";

constexpr const char* kEcho = R"(
import lcm
bus = lcm.LCM("udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304")
bus.subscribe(r"TO_PYTHON\.[a-z]+", lambda channel, data: bus.publish(channel.replace("TO_", "FROM_"), data))
while True:
    bus.handle()
)";

class PythonLcm : public ::testing::Test {
 protected:
  PythonLcm() {
    bus_.subscribe("FROM_PYTHON\\.echo", &PythonLcm::on_message, this)->setQueueCapacity(0);
    while (!echoes({1}) && --patience_ > 0) continue;  // Python starts
  }
  void on_message(const lcm::ReceiveBuffer* buffer, const std::string&) {
    const auto* data = static_cast<const std::uint8_t*>(buffer->data);
    received_.emplace_back(data, data + buffer->data_size);
  }
  // True when these bytes come back.
  bool echoes(const Bytes& data) {
    received_.clear();
    bus_.publish("TO_PYTHON.echo", data.data(), static_cast<unsigned>(data.size()));
    const auto end = std::chrono::steady_clock::now() + (data.size() > 1 ? kHangLimit : 1s);
    // What was sent while Python started may come late.
    while ((received_.empty() || received_.back() != data) && std::chrono::steady_clock::now() < end)
      bus_.handleTimeout(100);
    return !received_.empty() && received_.back() == data;
  }
  static void send_datagram(const std::string& datagram) {
    static const int datagrams = socket(AF_INET, SOCK_DGRAM, 0);  // one sender
    sockaddr_in group{};
    group.sin_family = AF_INET;
    group.sin_port = htons(7667);
    inet_pton(AF_INET, "239.255.76.67", &group.sin_addr);
    EXPECT_EQ(sendto(datagrams, datagram.data(), datagram.size(), 0, reinterpret_cast<sockaddr*>(&group),
                     sizeof group),
              static_cast<ssize_t>(datagram.size()));
  }

  int patience_ = 60;
  lcm::LCM bus_{kUrl};
  std::vector<Bytes> received_;
  Process python_{{"/usr/bin/env", "PYTHONPATH=" HALOCLINE_SOURCE_DIR "/clients/examples/python", "python3",
                   "-c", kEcho}};
};

Bytes pattern(std::size_t size) {
  Bytes data(size);
  for (std::size_t i = 0; i < size; ++i) data[i] = static_cast<std::uint8_t>(i * 131 + i / 251);
  return data;
}

// A datagram holds 65 499 bytes of name, zero and data; what is longer travels in fragments of 65 487.
TEST_F(PythonLcm, MessagesOfEverySizePassBothWays) {
  for (const std::size_t size : {2, 100, 65'482, 65'483, 65'484, 65'485, 130'960, 131'000, 1'000'000})
    EXPECT_TRUE(echoes(pattern(size))) << size << " bytes: " << python_.output();
}

TEST_F(PythonLcm, DatagramsThatAreNoMessageAreIgnored) {
  const std::string fragment = std::string("LC03") + std::string("\0\0\0\7\0\0\0\12\0\0\0\11\0\0\0\1", 16);
  for (const std::string& datagram :
       {std::string(), std::string("LC0"), std::string("LC02"), std::string("LC02\0\0\0\1no zero", 15),
        std::string("LC02\0\0\0\1\377\376\0x", 12), std::string("LC03\0\0\0", 7), fragment + "beyond the end",
        std::string("LC03\0\0\0\7\377\377\377\377\0\0\0\0\0\0\0\2x", 21), std::string("LC99 something else"),
        // Two fragments of a count, none of them the first.
        std::string("LC03\0\0\0\11\0\0\0\4\0\0\0\0\0\1\0\2ab", 22),
        std::string("LC03\0\0\0\11\0\0\0\4\0\0\0\2\0\2\0\3cd", 22),
        // A channel without its end.
        std::string("LC03\0\0\0\12\0\0\0\4\0\0\0\0\0\0\0\1TO_PYTHON.echo", 34)})
    send_datagram(datagram);
  EXPECT_TRUE(echoes(pattern(1000))) << python_.output();
  EXPECT_EQ(python_.output(), "");
}

TEST_F(PythonLcm, WhatIsWrongIsRefusedWithWhatIsAllowed) {
  for (const auto& [call, message] : std::vector<std::pair<std::string, std::string>>{
           {"lcm.LCM('tcpq://127.0.0.1:7700')",
            "ValueError: 'tcpq://127.0.0.1:7700': allowed is udpm://GROUP:PORT"},
           {"lcm.LCM('udpm://somewhere:7667')", "ValueError: 'udpm://somewhere:7667': illegal IP address"},
           {"lcm.LCM('udpm://239.255.76.67:7667?ttl=x')", "ttl=x': invalid literal"},
           {"lcm.LCM().subscribe('STATE.(', print)",
            "ValueError: the channel 'STATE.(' is no regular expression"},
           {"lcm.LCM().publish('C' * 64, b'')", "has 64 characters; allowed are 63"}}) {
    Process python({"/usr/bin/env", "PYTHONPATH=" HALOCLINE_SOURCE_DIR "/clients/examples/python", "python3",
                    "-c", "import lcm\n" + call});
    EXPECT_EQ(python.wait(), 1);
    EXPECT_NE(python.output().find(message), std::string::npos) << python.output();
  }
}

}  // namespace
}  // namespace halocline::testing
