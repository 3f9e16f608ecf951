// SPDX-License-Identifier: BSD-3-Clause
#include "conductor/conductor_node.h"

#include <utility>

#include "bus/transport/subscription.h"
#include "core/check.h"

namespace halocline::conductor {

ConductorNode::ConductorNode(lcm::LCM& lcm, bus::NodeIdentity identity, SimDuration period, double rate)
    : Node(lcm, std::move(identity)), period_(period), rate_(rate) {
  require(period > SimDuration(), "the clock period must be positive");
  require_in_range(rate, 0, 1e6, "clock rate");
  if (rate == 0) return;  // no other conductor is on its bus
  bus().subscribe<sim_clock_t>(
      bus::channels::kClock,
      [this](const sim_clock_t& clock) {
        if (clock.session == bus().identity().session) return;
        ++bus().counters().duplicate_publishers;
        bus().refuse(bus::channels::kClock,
                     "session is " + std::to_string(clock.session) + ", of a second conductor");
      },
      bus::Wakeup::kStoreOnly);
}

bus::Due ConductorNode::on_due() const { return {.sim = next_clock_}; }

// CLOCK carries the present time, not that of the grid: in a paced run the step comes slightly after it.
void ConductorNode::on_step(const bus::Now& now) {
  if (now.sim < next_clock_) return;
  sim_clock_t clock;
  clock.utime = now.sim.to_utime();
  clock.session = bus().identity().session;
  clock.sequence = sequence_++;
  clock.clock_rate = rate_;
  clock.clock_step_us = period_.nanoseconds() / 1000;
  clock.lockstep = rate_ == 0 ? 1 : 0;
  bus().publish(bus::channels::kClock, clock);
  next_clock_ = next_on_grid(now.sim, period_);
}

std::string ConductorNode::status_text() const {
  return rate_ == 0 ? "lockstep" : "real time, rate " + std::to_string(rate_);
}

}  // namespace halocline::conductor
