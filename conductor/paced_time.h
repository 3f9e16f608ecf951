// SPDX-License-Identifier: BSD-3-Clause
// Simulation time as the conductor generates it: the steady clock times a rate.
//
// A conductor that is started in a running system continues from the time to which the system has
// extrapolated. It listens for slightly longer than the period of STATUS, then starts from the latest utime
// that another utime confirms within a minute, or from 0. If another conductor is publishing CLOCK at that
// moment, it does not start, and the other one stays.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "bus/bus.h"
#include "bus/runtime/time_source.h"
#include "bus/transport/subscription.h"
#include "core/sim_time.h"

namespace halocline::conductor {

class PacedTime : public bus::TimeSource {
 public:
  // Long enough to receive the STATUS of every node, which is published once a second.
  static constexpr SimDuration kListening = SimDuration::from_milliseconds(1200);

  // `rate`: simulated seconds per second of steady time, above 0.
  PacedTime(lcm::LCM& lcm, double rate);

  // Throws NetworkError if another conductor runs: two CLOCKs of one session have been received, the last one
  // within a second.
  std::optional<SimTime> now(SimTime steady) override;
  SimTime steady_at(SimTime sim) const override;
  const bus::Subscriptions* receives() const override { return bus_ ? &bus_->receives() : nullptr; }

  void on_clock(const sim_clock_t& clock);
  // Processes a message of a running system with this utime, received at the steady time last set.
  void on_utime(std::int64_t utime);

 private:
  SimTime latest_confirmed();

  std::optional<bus::Bus> bus_;  // reset once time runs
  double rate_;
  std::optional<SimTime> started_listening_;
  SimTime zero_;                // simulation time at steady time 0
  std::vector<SimTime> zeros_;  // estimates of zero_, one for each message received so far
  struct {
    std::int64_t session = 0;
    int count = 0;
    SimTime received;
    std::int64_t utime = 0, sequence = 0;
  } other_;  // last conductor heard
  bool running_ = false;
};

}  // namespace halocline::conductor
