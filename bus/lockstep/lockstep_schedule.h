// SPDX-License-Identifier: BSD-3-Clause
// Step order of lockstep, for runs in one process or several: a discrete-event schedule.
//
// Time advances to the earliest instant at which a participant is due. At that instant the stages step in
// order (vehicles before pilots, the channel server last). All participants of a stage that are due step
// together: none receives the messages that the others of its stage publish in that round. Their messages are
// ordered (by participant, then in the order of publication) and delivered; then the next stage steps. Passes
// over the stages are repeated until no participant is due at that instant.
//
// The order of all messages of a run thus depends only on the participants and their messages, never on the
// duration of a computation or the order of joining.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/sim_time.h"

namespace halocline::bus {

// State of a participant in the schedule.
struct ScheduleEntry {
  int stage = 0;
  SimTime due = SimTime::never();
  bool has_input = false;  // messages that may advance its due time: it steps at the present instant
  // Promise: before this time the participant publishes no message that may make another one due, except a
  // service, unless it gets input from a participant that is not a service. Before `due` it publishes nothing
  // anyway.
  SimTime lookahead = SimTime::at_once();
};

class LockstepSchedule {
 public:
  SimTime now() const { return now_; }

  // Returns the earliest instant at which an entry is due, at least the present one; never() when none is. An
  // entry with input is due at the present instant.
  SimTime next_instant(std::span<const ScheduleEntry> entries) const;
  // Advances to `instant`, which must not be before now().
  void begin(SimTime instant);
  // Returns the entries of the next round at now(), all of one stage, as ascending indices; empty when the
  // instant is over. `entries` must be in ascending order of stage. Throws std::runtime_error when an instant
  // does not end.
  std::vector<std::size_t> round(std::span<const ScheduleEntry> entries);
  // Continues at `instant` with the next stage, after a participant of `stage` that stepped alone has used
  // its lookahead up to there.
  void resume_after(SimTime instant, int stage);

 private:
  SimTime now_;
  int next_stage_ = 0;
  int passes_ = 0;
};

// Returns the lookahead of the entry that steps alone: it may take all of its own steps before this instant.
// A due time is a promise to publish nothing before it unless a message is received. Therefore, until the
// earliest of the others is due, nobody can publish a message to it. at_once() when another entry has input.
SimTime lookahead_alone(std::span<const ScheduleEntry> entries, std::size_t alone);

// Returns the lookahead that the entries of one stage share: each may take all of its own steps before this
// instant, because until then none of the other entries is due, and none of the stage publishes a message
// that others of the stage receive. There is no lookahead if the result is `now` or earlier. It is at most
// kLongestSharedLookahead.
//
// A service (Stage::kTerrain) may receive requests and answer them meanwhile. It publishes only answers to
// messages, at the instant of the message, to its sender, so other participants may have stepped beyond that
// instant.
inline constexpr SimDuration kLongestSharedLookahead = SimDuration::from_milliseconds(100);
SimTime shared_lookahead(std::span<const ScheduleEntry> entries, int stage, SimTime now);

}  // namespace halocline::bus
