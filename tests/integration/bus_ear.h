// Listens on udpm and keeps what the tests of separate processes ask about.
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

class BusEar {
 public:
  BusEar();

  // Handles what comes for so long.
  void listen(double seconds);
  // Listens until `condition` holds; false when it did not within `seconds`.
  template <class Condition>
  bool listen_until(double seconds, Condition condition) {
    for (double left = seconds; left > 0; left -= kSlice) {
      listen(kSlice);
      if (condition()) return true;
    }
    return false;
  }
  // Messages heard on `channel` (exact) since the last clear().
  std::int64_t heard(const std::string& channel) const;
  void clear() { counts_.clear(); }

  lcm::LCM& lcm() { return *lcm_; }
  std::vector<link_table_t> tables;
  std::vector<packet_outcome_t> outcomes;
  std::map<std::string, node_status_t> last_status;  // by node
  std::int64_t last_clock_utime = 0;

 private:
  static constexpr double kSlice = 0.02;
  void on_any(const lcm::ReceiveBuffer*, const std::string& channel) { ++counts_[channel]; }

  std::unique_ptr<lcm::LCM> lcm_;
  bus::Bus bus_;
  std::map<std::string, std::int64_t> counts_;
};

}  // namespace halocline::testing
