// SPDX-License-Identifier: BSD-3-Clause
// A subscriber on udpm for tests of separate processes: counts messages by channel and keeps those that tests check.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "bus/bus.h"
#include "bus/transport.h"

namespace halocline::testing {

class BusMonitor {
 public:
  BusMonitor();

  // Dispatches messages for so long.
  void dispatch_for(double seconds);
  // Dispatches until `condition` holds; false when it did not within `seconds` of processor time: while more processes
  // want to run than there are processors, the time passes by the share that each gets.
  template <class Condition>
  bool wait_until(double seconds, Condition condition) {
    for (double left = seconds; left > 0; left -= kSlice * processor_share()) {
      dispatch_for(kSlice);
      if (condition()) return true;
    }
    return false;
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
  static constexpr double kSlice = 0.02;
  // Of one process at this instant, above 0, at most 1.
  static double processor_share();
  void on_any(const lcm::ReceiveBuffer*, const std::string& channel) { ++counts_[channel]; }

  std::unique_ptr<lcm::LCM> lcm_;
  bus::Bus bus_;
  std::map<std::string, std::int64_t> counts_;
};

}  // namespace halocline::testing
