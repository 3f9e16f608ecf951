// SPDX-License-Identifier: BSD-3-Clause
// Logs made by hand, in a file of the test's own.
#pragma once

#include <cstdint>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>
#include <unistd.h>

#include "bus/logs/log_reader.h"
#include "bus/messages/messages.h"

namespace halocline::clients::testing {

class TemporaryLog {
 public:
  explicit TemporaryLog(const std::string& suffix = "")
      : path_(::testing::TempDir() + "halocline-" + std::to_string(getpid()) + "-" +
              ::testing::UnitTest::GetInstance()->current_test_info()->name() + suffix + ".lcm"),
        file_(std::make_unique<lcm::LogFile>(path_, "w")) {}
  ~TemporaryLog() { std::remove(path_.c_str()); }

  void add_bytes(std::int64_t stamp_us, const std::string& channel, std::vector<std::uint8_t> bytes) {
    lcm::LogEvent event;
    event.eventnum = count_++;
    event.timestamp = stamp_us;
    event.channel = channel;
    event.datalen = static_cast<std::int32_t>(bytes.size());
    event.data = bytes.data();
    file_->writeEvent(&event);
  }
  template <class Message>
  void add(std::int64_t stamp_us, const std::string& channel, const Message& message) {
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
    message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    add_bytes(stamp_us, channel, std::move(bytes));
  }

  // Closes the log for reading.
  const std::string& path() {
    file_.reset();
    return path_;
  }
  std::string bytes() {
    std::ifstream in(path(), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void replace_bytes(const std::string& bytes) { std::ofstream(path(), std::ios::binary) << bytes; }

 private:
  std::string path_;
  std::unique_ptr<lcm::LogFile> file_;
  std::int64_t count_ = 0;
};

inline vehicle_state_t state_at(std::int64_t utime, double north_m = 0) {
  vehicle_state_t state{};
  state.utime = utime;
  state.vehicle_id = 1;
  state.position_ned_m[0] = north_m;
  state.orientation_wxyz[0] = 1;
  return state;
}

inline sim_clock_t clock_at(std::int64_t utime) {
  sim_clock_t clock{};
  clock.utime = utime;
  clock.clock_step_us = 100'000;
  return clock;
}

inline std::vector<LoggedEvent> all_of(LogReader& log) {
  std::vector<LoggedEvent> events;
  for (LoggedEvent event; log.next(event);) events.push_back(event);
  return events;
}

}  // namespace halocline::clients::testing
