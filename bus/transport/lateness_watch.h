// SPDX-License-Identifier: BSD-3-Clause
// Lateness of a node's results: the simulation time by CLOCK when a message is published, minus the message's
// own utime. By this measure a node that was halted, or that computes for too long, is late whatever time it
// has reached itself.
//
// Quantiles over the last minute are those of a histogram with bins 2^(1/8) wide, so they are at most 9 % too
// large. The maximum is exact.
//
// The class has no side effects: `steady` is the caller's steady time, which never decreases. Memory is
// constant.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "core/sim_time.h"

namespace halocline::bus {

// Lateness in seconds of simulated time, 0 and up; 0 while nothing was published.
struct Lateness {
  double p50_s = 0, p99_s = 0, max_s = 0;
};

class LatenessWatch {
 public:
  // Returns the simulation time by CLOCK, nothing while it is unknown. After set_clock(), a message published
  // more than `limit` after its instant is late; with 0, none is.
  using Clock = std::function<std::optional<SimTime>()>;
  void set_clock(Clock clock, SimDuration limit);
  SimDuration limit() const { return limit_; }
  // Records that a result due at `instant` is published. Returns true when it is late.
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
  static double end_of(std::size_t bin);  // upper limit, s

  Clock clock_;
  SimDuration limit_;
  std::array<Slot, kSlots> slots_;
};

}  // namespace halocline::bus
