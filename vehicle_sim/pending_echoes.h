// SPDX-License-Identifier: BSD-3-Clause
// Queue of measurements that wait for their echoes, in order of time, until answered or timed out.
//
// There is one entry for each sensor tick. An entry is complete when its echoes are known (at once when it
// has no beams) or its deadline has passed. Entries leave in the order in which they entered, so that
// messages are published in order of time.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "core/sim_time.h"
#include "vehicle_sim/sensor_station.h"

namespace halocline::vehicle_sim {

class PendingEchoes {
 public:
  // `deadline`: steady time at which the tick is released without echoes.
  void wait(std::int64_t request_id, SensorTick tick, SimTime deadline);

  // Returns the tick that waits for this answer, for the caller to write the echoes into, and marks it as
  // answered. Null when no tick waits for it.
  [[nodiscard]] SensorTick* answer(std::int64_t request_id);

  // Removes and returns the oldest tick if it is complete at `steady`.
  [[nodiscard]] std::optional<SensorTick> take(SimTime steady);

  bool has_complete() const { return !waiting_.empty() && waiting_.front().answered; }
  // Deadline of the oldest tick; never() when none waits.
  SimTime next_deadline() const { return waiting_.empty() ? SimTime::never() : waiting_.front().deadline; }
  std::int64_t expired() const { return expired_; }
  void clear() { waiting_.clear(); }

 private:
  struct PendingQuery {
    std::int64_t request_id;
    SensorTick tick;
    SimTime deadline;
    bool answered = false;
  };
  std::deque<PendingQuery> waiting_;
  std::int64_t expired_ = 0;  // ticks released unanswered
};

}  // namespace halocline::vehicle_sim
