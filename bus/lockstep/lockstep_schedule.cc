// SPDX-License-Identifier: BSD-3-Clause
#include "bus/lockstep/lockstep_schedule.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "core/check.h"

namespace halocline::bus {
namespace {

// A chain of messages at one instant has a few links; this many passes indicate a livelock.
constexpr int kMaxPassesPerInstant = 100'000;
constexpr int kFirstStage = std::numeric_limits<int>::min();

bool is_due(const ScheduleEntry& entry, SimTime now) { return entry.has_input || entry.due <= now; }

}  // namespace

SimTime LockstepSchedule::next_instant(std::span<const ScheduleEntry> entries) const {
  SimTime next = SimTime::never();
  for (const ScheduleEntry& entry : entries) next = std::min(next, entry.has_input ? now_ : entry.due);
  return std::max(next, now_);
}

void LockstepSchedule::begin(SimTime instant) {
  ensure(instant >= now_, "time does not run backwards");
  now_ = instant;
  next_stage_ = kFirstStage;
  passes_ = 0;
}

void LockstepSchedule::resume_after(SimTime instant, int stage) {
  if (instant > now_) begin(instant);
  next_stage_ = stage + 1;
}

std::vector<std::size_t> LockstepSchedule::round(std::span<const ScheduleEntry> entries) {
  const auto first_from = [&](int stage) {
    return std::find_if(entries.begin(), entries.end(), [&](const ScheduleEntry& entry) {
      return entry.stage >= stage && is_due(entry, now_);
    });
  };
  auto first = first_from(next_stage_);
  if (first == entries.end()) {
    first = first_from(kFirstStage);
    if (++passes_ == kMaxPassesPerInstant) {
      throw std::runtime_error(
          "nodes keep each other busy without end at t=" + std::to_string(now_.seconds()) + " s");
    }
  }
  std::vector<std::size_t> round;
  if (first == entries.end()) return round;
  next_stage_ = first->stage + 1;
  for (auto entry = first; entry != entries.end() && entry->stage == first->stage; ++entry) {
    if (is_due(*entry, now_)) round.push_back(static_cast<std::size_t>(entry - entries.begin()));
  }
  return round;
}

SimTime lookahead_alone(std::span<const ScheduleEntry> entries, std::size_t alone) {
  SimTime lookahead = SimTime::never();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (i == alone) continue;
    lookahead = std::min(lookahead, entries[i].has_input ? SimTime::at_once() : entries[i].due);
  }
  return lookahead;
}

SimTime shared_lookahead(std::span<const ScheduleEntry> entries, int stage, SimTime now) {
  SimTime lookahead = now + kLongestSharedLookahead;
  for (const ScheduleEntry& entry : entries) {
    const SimTime promised = entry.stage == stage ? std::max(entry.due, entry.lookahead) : entry.due;
    lookahead = std::min(lookahead, entry.has_input ? SimTime::at_once() : promised);
  }
  return lookahead;
}

}  // namespace halocline::bus
