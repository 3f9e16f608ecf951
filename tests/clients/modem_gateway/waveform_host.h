// SPDX-License-Identifier: BSD-3-Clause
// A host of a modem that plays and records waveforms (UASP2): what it plays, and what the modem streams to
// it.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "acoustics/waveform/moving_link.h"
#include "clients/modem_gateway/endpoint.h"
#include "core/text/base64.h"

namespace halocline::modem_gateway::testing {

// A port of UDP on loopback, and the samples of the units that came.
class DataPort {
 public:
  DataPort() : file_(socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
    const int size = 8 << 20;
    setsockopt(file_.get(), SOL_SOCKET, SO_RCVBUF, &size, sizeof size);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    inet_pton(AF_INET, "127.0.0.1", &address.sin_addr);
    bind(file_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address);
  }
  std::string istart() const {
    return "{\"action\":\"istart\",\"port\":" + std::to_string(port_of(file_)) + "}\n";
  }
  void take(acoustics::Samples& heard) {
    std::vector<std::uint8_t> unit(2000);
    for (ssize_t size = 0; (size = recv(file_.get(), unit.data(), unit.size(), 0)) > 0;) {
      const auto number = [&](std::size_t at, std::size_t bytes) {
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < bytes; ++i) value = value << 8 | unit[at + i];
        return value;
      };
      ASSERT_EQ(number(8, 4), next_++) << "a unit is missing";
      if (heard.values.empty())
        heard.begin_s = std::round(static_cast<double>(number(0, 8)) * 1e-6 * heard.rate_hz) / heard.rate_hz;
      for (std::size_t i = 16; i < static_cast<std::size_t>(size); i += 4)
        heard.values.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(number(i, 4))));
    }
  }

 private:
  FileDescriptor file_;
  std::uint64_t next_ = 0;
};

// The lines that put a sound into the buffer of the DAC.
inline std::vector<std::string> odata(const std::vector<double>& samples) {
  constexpr std::size_t kUnit = 10'000;
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < samples.size(); begin += kUnit) {
    const std::size_t count = std::min(kUnit, samples.size() - begin);
    std::vector<std::uint8_t> bytes(12);
    bytes.insert(bytes.end(),
                 {static_cast<std::uint8_t>(count >> 8), static_cast<std::uint8_t>(count), 0, 1});
    for (std::size_t i = begin; i < begin + count; ++i) {
      const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(samples[i]));
      for (const int shift : {24, 16, 8, 0}) bytes.push_back(static_cast<std::uint8_t>(bits >> shift));
    }
    lines.push_back(R"({"action":"odata","data":")" + base64_of(bytes) + "\"}\n");
  }
  return lines;
}
inline std::string ostart(double at_s) {
  return "{\"action\":\"ostart\",\"time\":" + std::to_string(std::llround(at_s * 1e6)) + "}\n";
}

// From 20 to 30 kHz.
inline std::vector<double> sweep(double rate_hz, double seconds) {
  std::vector<double> values;
  for (int n = 0; n < seconds * rate_hz; ++n) {
    const double t = n / rate_hz;
    values.push_back(static_cast<float>(std::sin(2 * std::numbers::pi * (20'000 + 5'000 / seconds * t) * t)));
  }
  return values;
}

inline double rms(const std::vector<double>& values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

}  // namespace halocline::modem_gateway::testing
