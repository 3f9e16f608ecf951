// SPDX-License-Identifier: BSD-3-Clause
// A program of a test that has what was lost on the way to it repaired, as nodes do.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "bus/bus.h"
#include "bus/runtime/node_process.h"
#include "bus/transport/node_identity.h"
#include "bus/transport/transport.h"
#include "core/sim_time.h"
#include "tests/support/process.h"

namespace halocline::testing {

class BusListener {
 public:
  // On the bus of this process.
  explicit BusListener(const std::string& name)
      : lcm_(bus::open_transport(bus::effective_url(""))), bus_(*lcm_, {name, 4711}) {
    bus_.enable_repair();
  }
  // Handles what has come, and requests what is missing.
  void dispatch() {
    bus_.set_steady(bus::steady_now());
    while (lcm_->handleTimeout(0) > 0) {
    }
    bus_.rethrow_if_failed();
    bus_.repair(SimTime(), bus::steady_now());
  }
  // Until `condition` holds; false when nothing makes it hold.
  template <class Condition>
  bool listen_until(Condition condition) {
    return listen_until(static_cast<double>(kHangLimit.count()), condition);
  }
  // Until `condition` holds, `seconds` at most; returns whether it does.
  template <class Condition>
  bool listen_until(double seconds, Condition condition) {
    const SimTime end = bus::steady_now() + SimDuration::from_seconds(seconds);
    while (bus::steady_now() < end && !condition()) {
      dispatch();
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return condition();
  }
  void listen_for(double seconds) {
    listen_until(seconds, [] { return false; });
  }
  const bus::BusCounters& counters() const { return bus_.counters(); }

 private:
  std::unique_ptr<lcm::LCM> lcm_;

 protected:
  bus::Bus bus_;
};

}  // namespace halocline::testing
