#include "bus/runtime/lockstep_runner.h"

#include <algorithm>
#include <tuple>

namespace halocline::bus {

LockstepRunner::LockstepRunner(lcm::LCM& lcm, std::vector<Node*> nodes)
    : lcm_(lcm), nodes_(std::move(nodes)) {
  std::stable_sort(nodes_.begin(), nodes_.end(), [](const Node* a, const Node* b) {
    return std::forward_as_tuple(a->stage(), a->name()) < std::forward_as_tuple(b->stage(), b->name());
  });
}

void LockstepRunner::run_until(SimTime end) {
  for (SimTime next = schedule_.next_instant(schedule_entries()); next <= end;
       next = schedule_.next_instant(schedule_entries())) {
    if (before_instant_ && !before_instant_(next)) return;
    now_ = next;
    schedule_.begin(next);
    step_all_due();
  }
  now_ = std::max(now_, end);
}

std::vector<ScheduleEntry> LockstepRunner::schedule_entries() const {
  std::vector<ScheduleEntry> entries;
  for (const Node* node : nodes_) {
    entries.push_back({static_cast<int>(node->stage()), std::max(node->lockstep_due(), now_)});
  }
  return entries;
}

void LockstepRunner::step_all_due() {
  for (auto round = schedule_.round(schedule_entries()); !round.empty();
       round = schedule_.round(schedule_entries())) {
    for (const std::size_t i : round) nodes_[i]->step({now_, now_});
    drain();
  }
}

void LockstepRunner::drain() {
  while (lcm_.handleTimeout(0) > 0) {
  }
}

void LockstepRunner::stop() {
  for (Node* node : nodes_) {
    node->stop({now_, now_});
    drain();
  }
}

}  // namespace halocline::bus
