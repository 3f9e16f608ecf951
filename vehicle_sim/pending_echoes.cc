// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/pending_echoes.h"

#include <algorithm>
#include <utility>

namespace halocline::vehicle_sim {

void PendingEchoes::wait(std::int64_t request_id, SensorTick tick, SimTime deadline) {
  const bool asks_nothing = tick.beams.empty();
  waiting_.push_back({request_id, std::move(tick), deadline, asks_nothing});
}

SensorTick* PendingEchoes::answer(std::int64_t request_id) {
  const auto entry = std::find_if(waiting_.begin(), waiting_.end(), [&](const PendingQuery& e) {
    return e.request_id == request_id && !e.answered;
  });
  if (entry == waiting_.end()) return nullptr;
  entry->answered = true;
  return &entry->tick;
}

std::optional<SensorTick> PendingEchoes::take(SimTime steady) {
  if (waiting_.empty()) return {};
  PendingQuery& oldest = waiting_.front();
  if (!oldest.answered && steady < oldest.deadline) return {};
  if (!oldest.answered) ++expired_;
  SensorTick tick = std::move(oldest.tick);
  waiting_.pop_front();
  return tick;
}

}  // namespace halocline::vehicle_sim
