// SPDX-License-Identifier: BSD-3-Clause
// Queue of measurements that wait for their echoes, in order of time, until answered or timed out.
//
// One entry a sensor tick. An entry is complete when its echoes are known (at once when
// it has no beams) or its deadline has passed; entries leave in the order in which they came, so
// messages go out in order of time.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "core/sim_time.h"
#include "vehicle_sim/sensor_station.h"

namespace halocline::vehicle_sim {

class PendingEchoes {
 public:
  // `deadline`: steady time at which the tick goes out without echoes.
  void wait(std::int64_t request_id, SensorTick tick, SimTime deadline);

  // The tick that waits for this answer, to write its echoes into; null when none does (any more). It then
  // counts as answered.
  [[nodiscard]] SensorTick* answer(std::int64_t request_id);

  // The oldest tick if it is complete at `steady`, taken out.
  [[nodiscard]] std::optional<SensorTick> take(SimTime steady);

  bool has_complete() const { return !waiting_.empty() && waiting_.front().answered; }
  // When the oldest tick is given up; never() when none waits.
  SimTime next_deadline() const { return waiting_.empty() ? SimTime::never() : waiting_.front().deadline; }
  std::int64_t given_up() const { return given_up_; }
  void clear() { waiting_.clear(); }

 private:
  struct PendingQuery {
    std::int64_t request_id;
    SensorTick tick;
    SimTime deadline;
    bool answered = false;
  };
  std::deque<PendingQuery> waiting_;
  std::int64_t given_up_ = 0;  // ticks that went out unanswered
};

}  // namespace halocline::vehicle_sim
