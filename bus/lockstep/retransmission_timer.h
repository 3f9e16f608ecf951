// SPDX-License-Identifier: BSD-3-Clause
// Retransmission timer, after Jacobson, "Congestion avoidance and control" (1988):
//
//   timeout = mean + 4 deviation,
//   mean += (t - mean) / 8,    deviation += (|t - mean| - deviation) / 4,
//
// where t is the latest round-trip time. Karn's rule: a request that was sent more than once yields no
// sample.
//
// The timeout doubles from the third retransmission on, up to kMax; before that, a lost datagram is likelier
// than a slow or absent peer. The computing time of the participant is part of the round trip.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/sim_time.h"

namespace halocline::conductor {

class RetransmissionTimer {
 public:
  static constexpr SimDuration kMin = SimDuration::from_microseconds(1000);
  static constexpr SimDuration kAtFirst = SimDuration::from_milliseconds(20);
  static constexpr SimDuration kMax = SimDuration::from_milliseconds(200);

  // The request was sent, for the first time or again, at this steady time.
  void on_sent(SimTime steady) {
    if (times_sent_++ == 0) first_sent_ = steady;
    const int doublings = std::clamp(times_sent_ - 3, 0, 10);
    expires_at_ = steady + std::min(timeout() * (std::int64_t{1} << doublings), kMax);
  }
  // The answer was received.
  void on_answered(SimTime steady) {
    if (times_sent_ == 1) add_sample(steady - first_sent_);
    times_sent_ = 0;
    expires_at_ = SimTime::never();
  }
  // Time at which to send the request again; never() while no answer is outstanding.
  SimTime expires_at() const { return expires_at_; }

 private:
  SimDuration timeout() const { return known_ ? std::clamp(mean_ + deviation_ * 4, kMin, kMax) : kAtFirst; }
  void add_sample(SimDuration round_trip) {
    if (!known_) {
      mean_ = round_trip;
      deviation_ = SimDuration::from_nanoseconds(round_trip.nanoseconds() / 2);
      known_ = true;
      return;
    }
    const std::int64_t error = (round_trip - mean_).nanoseconds();
    mean_ = SimDuration::from_nanoseconds(mean_.nanoseconds() + error / 8);
    deviation_ = SimDuration::from_nanoseconds(deviation_.nanoseconds() +
                                               ((error < 0 ? -error : error) - deviation_.nanoseconds()) / 4);
  }

  bool known_ = false;
  SimDuration mean_, deviation_;
  int times_sent_ = 0;
  SimTime first_sent_, expires_at_ = SimTime::never();
};

}  // namespace halocline::conductor
