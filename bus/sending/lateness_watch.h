// SPDX-License-Identifier: BSD-3-Clause
// Lateness of a node's results: the simulation time by CLOCK when a message goes out, less the
// message's own utime. A node that was stopped, or that computes for longer than it has, is late by that
// measure whatever time it has reached itself.
//
// Quantiles over the last minute are those of a histogram whose bins are 2^(1/8) wide: too great by 9 % at
// most. The greatest is exact.
//
// Pure: `steady` is the caller's steady time, never set back. Memory is constant.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "core/sim_time.h"

namespace halocline::bus {

// Seconds of simulated time, 0 and up; 0 while nothing was published.
struct Lateness {
  double p50_s = 0, p99_s = 0, max_s = 0;
};

class LatenessWatch {
 public:
  // Simulation time by CLOCK at this moment, empty while unknown. From now on what goes out more than `limit`
  // after its instant is late; 0: nothing is.
  using Clock = std::function<std::optional<SimTime>()>;
  void set_clock(Clock clock, SimDuration limit);
  SimDuration limit() const { return limit_; }
  // A result that was due at `instant` goes out. True when it is late.
  bool note(SimTime steady, SimTime instant);
  void add(SimTime steady, SimDuration lateness);
  // Quantiles and maximum of the last minute.
  Lateness summary(SimTime steady);

 private:
  static constexpr std::size_t kSlots = 60, kBins = 256;
  static constexpr SimDuration kSlot = SimDuration::from_milliseconds(1000);
  struct Slot {
    std::int64_t number = -1;  // seconds since steady time 0
    std::array<std::uint32_t, kBins> bins{};
    double max_s = 0;
  };
  static std::size_t bin_of(double seconds);
  static double end_of(std::size_t bin);  // seconds

  Clock clock_;
  SimDuration limit_;
  std::array<Slot, kSlots> slots_;
};

}  // namespace halocline::bus
