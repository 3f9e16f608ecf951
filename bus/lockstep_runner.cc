#include "bus/lockstep_runner.h"

#include <algorithm>
#include <stdexcept>

namespace halocline::bus {
namespace {

// A chain of answers to answers at one instant is a handful; this many means that it never ends.
constexpr int kMostRoundsPerInstant = 100'000;

SimTime earliest(const Due& due) { return std::min(due.sim, due.steady); }

}  // namespace

LockstepRunner::LockstepRunner(lcm::LCM& lcm, std::vector<Node*> nodes)
    : lcm_(lcm), nodes_(std::move(nodes)) {}

void LockstepRunner::run_until(SimTime end) {
  for (SimTime next = next_instant(); next <= end; next = next_instant()) {
    if (before_instant_ && !before_instant_(next)) return;
    now_ = next;
    step_all_due();
  }
  now_ = std::max(now_, end);
}

SimTime LockstepRunner::next_instant() const {
  SimTime next = SimTime::never();
  for (const Node* node : nodes_) next = std::min(next, earliest(node->due()));
  return std::max(next, now_);
}

void LockstepRunner::step_all_due() {
  bool any_due = true;
  for (int round = 0; any_due; ++round) {
    if (round == kMostRoundsPerInstant) {
      throw std::runtime_error(
          "nodes keep each other busy without end at t=" + std::to_string(now_.seconds()) + " s");
    }
    any_due = false;
    for (Node* node : nodes_) {
      if (earliest(node->due()) > now_) continue;
      any_due = true;
      node->step({now_, now_});
      drain();
    }
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
