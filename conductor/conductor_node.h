// SPDX-License-Identifier: BSD-3-Clause
// Node of the conductor: publishes CLOCK, the simulation time, on the grid of the clock period. In real time
// it refuses and reports CLOCKs of other conductors; nodes keep the conductor that they accepted first
// (bus/runtime/time_source.h).
#pragma once

#include <cstdint>
#include <string>

#include "bus/runtime/node.h"
#include "bus/transport/node_identity.h"
#include "core/sim_time.h"

namespace halocline::conductor {

class ConductorNode : public bus::Node {
 public:
  // `rate`: simulated seconds per wall second that CLOCK announces; 0 if time is not paced (lockstep in one
  // process), so that receivers do not extrapolate. `period` > 0.
  ConductorNode(lcm::LCM& lcm, bus::NodeIdentity identity, SimDuration period, double rate);

 protected:
  bus::Due on_due() const override;
  void on_step(const bus::Now& now) override;
  std::string status_text() const override;

 private:
  SimDuration period_;
  double rate_;
  SimTime next_clock_;
  std::int64_t sequence_ = 0;
};

}  // namespace halocline::conductor
