// SPDX-License-Identifier: BSD-3-Clause
// A subscriber on udpm for tests of separate processes: counts messages by channel and keeps those that tests
// check.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "bus/bus.h"
#include "bus/transport/transport.h"
#include "tests/support/process.h"

namespace halocline::testing {

class BusMonitor {
 public:
  BusMonitor();

  // Dispatches messages for so long.
  void dispatch_for(double seconds);
  // Dispatches until `condition` holds; false when nothing makes it hold.
  template <class Condition>
  bool wait_until(Condition condition) {
    const auto end = std::chrono::steady_clock::now() + kHangLimit;
    while (!condition()) {
      if (std::chrono::steady_clock::now() > end) return false;
      dispatch_for(kSlice_s);
    }
    return true;
  }
  // Messages received on `channel` (exact) since the last clear().
  std::int64_t received(const std::string& channel) const;
  void clear() { counts_.clear(); }

  lcm::LCM& lcm() { return *lcm_; }
  std::vector<link_table_t> tables;
  std::vector<packet_outcome_t> outcomes;
  std::map<std::string, node_status_t> last_status;  // by node
  std::int64_t last_clock_utime = 0;

 private:
  static constexpr double kSlice_s = 0.02;
  void on_any(const lcm::ReceiveBuffer*, const std::string& channel) { ++counts_[channel]; }

  std::unique_ptr<lcm::LCM> lcm_;
  bus::Bus bus_;
  std::map<std::string, std::int64_t> counts_;
};

}  // namespace halocline::testing
