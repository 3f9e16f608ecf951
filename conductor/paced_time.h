// Simulation time as the conductor makes it: the steady clock times a rate.
//
// A conductor that is started into a running system continues from the time that the system has coasted to: it
// listens for a little more than the period of STATUS, then starts from the latest utime received, or from 0.
#pragma once

#include <cstdint>
#include <optional>

#include "bus/bus.h"
#include "bus/runtime/time_source.h"
#include "bus/subscription.h"
#include "core/sim_time.h"

namespace halocline::conductor {

class PacedTime : public bus::TimeSource {
 public:
  // Long enough to receive every node's STATUS, published once a second.
  static constexpr SimDuration kListening = SimDuration::from_milliseconds(1200);

  // `rate`: simulated seconds per second of steady time, above 0.
  PacedTime(lcm::LCM& lcm, double rate);

  std::optional<SimTime> now(SimTime steady) override;
  SimTime steady_at(SimTime sim) const override;
  const bus::Subscriptions* receives() const override { return bus_ ? &bus_->receives() : nullptr; }

  // A message of a running system with this utime was received at the steady time last set.
  void on_utime(std::int64_t utime);

 private:
  std::optional<bus::Bus> bus_;  // until it runs
  double rate_;
  std::optional<SimTime> started_listening_;
  SimTime zero_;  // simulation time at steady time 0, from the messages received so far
  bool has_received_ = false;
  bool running_ = false;
};

}  // namespace halocline::conductor
