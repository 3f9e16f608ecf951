// SPDX-License-Identifier: BSD-3-Clause
// The real program, pages that are open in it, and vehicles on its bus, for tests.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "bus/bus.h"
#include "bus/transport/transport.h"
#include "tests/runs/timeline/timeline_fixtures.h"
#include "tests/support/process.h"
#include "tests/viewer/web_client.h"

namespace halocline::monitor::testing {

using halocline::testing::host_of;
using halocline::testing::Process;
using halocline::testing::WebClient;
using nlohmann::json;
using std::chrono::milliseconds;

inline constexpr char kProtocol[] = "Sec-WebSocket-Protocol: halocline.monitor.v1\r\n";
inline constexpr char kOpened[] = "HTTP/1.1 101 Switching Protocols";

class Program {
 public:
  explicit Program(std::vector<std::string> arguments = {}) : process_(command(arguments)) {
    for (int i = 0; i < 1000 && port_ == 0 && process_.running(); ++i) {
      const std::string text = process_.output();
      const std::size_t at = text.find("http://127.0.0.1:");
      if (at != std::string::npos && text.find('\n', at) != std::string::npos)
        port_ = static_cast<std::uint16_t>(std::stoi(text.substr(at + 17)));
      else
        std::this_thread::sleep_for(milliseconds(20));
    }
  }

  std::uint16_t port() const { return port_; }
  Process& process() { return process_; }
  double resident_mb() const {
    std::ifstream in("/proc/" + std::to_string(process_.pid()) + "/statm");
    double all = 0, resident = 0;
    in >> all >> resident;
    return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
  }

 private:
  static std::vector<std::string> command(const std::vector<std::string>& arguments) {
    std::vector<std::string> all{std::string(HALOCLINE_BIN_DIR) + "/halocline-monitor"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return all;
  }
  Process process_;
  std::uint16_t port_ = 0;
};

class Page {
 public:
  explicit Page(std::uint16_t port) : client_(port) {
    opened_ = client_.open("/ws", host_of(port) + kProtocol) == kOpened;
  }
  bool opened() const { return opened_; }
  WebClient& client() { return client_; }

  // The next JSON message for which `fits` holds; null when none comes.
  json await(const std::function<bool(const json&)>& fits) {
    const auto end = std::chrono::steady_clock::now() + halocline::testing::kHangLimit;
    while (std::chrono::steady_clock::now() < end) {
      const auto message = client_.next(milliseconds(500));
      if (!message) continue;
      if (message->binary) {
        last_frame = message->bytes;
        continue;
      }
      json text = json::parse(message->bytes);
      if (fits(text)) return text;
    }
    return nullptr;
  }
  json await_type(const std::string& type) {
    return await([&](const json& message) { return message["type"] == type; });
  }
  json ask(json request) {
    request["id"] = ++last_id_;
    client_.send_message(request.dump());
    return await(
        [&](const json& message) { return message["type"] == "reply" && message["id"] == last_id_; });
  }
  // The next vehicle frame's instant, s; below 0 when none comes.
  double next_frame_s() {
    const auto end = std::chrono::steady_clock::now() + halocline::testing::kHangLimit;
    while (std::chrono::steady_clock::now() < end) {
      const auto message = client_.next(milliseconds(200));
      if (!message || !message->binary || message->bytes[0] != 1) continue;
      last_frame = message->bytes;
      double time_s = 0;
      std::memcpy(&time_s, message->bytes.data() + 4, sizeof time_s);
      return time_s;
    }
    return -1;
  }

  std::string last_frame;

 private:
  WebClient client_;
  bool opened_ = false;
  int last_id_ = 0;
};

// Publishes the states of `vehicles`, ten times a second each, in a thread of its own.
class Fleet {
 public:
  explicit Fleet(int vehicles) : thread_([this, vehicles] { run(vehicles); }) {}
  ~Fleet() {
    stop_ = true;
    thread_.join();
  }
  Fleet(const Fleet&) = delete;
  Fleet& operator=(const Fleet&) = delete;
  double time_s() const { return time_s_; }

 private:
  void run(int vehicles) {
    const auto lcm = bus::open_transport(bus::effective_url(""));
    bus::Bus bus(*lcm, {"fleet", 1});
    for (std::int64_t tick = 0; !stop_; ++tick) {
      for (int id = 1; id <= vehicles; ++id)
        bus.publish(
            "STATE.auv-" + std::to_string(id),
            clients::testing::state(id, tick * 100'000, 0.1 * static_cast<double>(tick), id * 10.0, 20));
      time_s_ = 0.1 * static_cast<double>(tick);
      std::this_thread::sleep_for(milliseconds(100));
    }
  }
  std::atomic<bool> stop_ = false;
  std::atomic<double> time_s_ = 0;
  std::thread thread_;
};

}  // namespace halocline::monitor::testing
