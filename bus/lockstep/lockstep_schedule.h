// SPDX-License-Identifier: BSD-3-Clause
// Step order of lockstep, for runs in one process and in many: a discrete-event schedule.
//
// Time advances to the earliest instant at which a participant is due. There the stages step in their order
// (vehicles before pilots, the channel server last), and all participants of a stage that are due step
// together: none receives what the others of its stage publish in that round. Their messages are ordered (by
// participant, then as each published them) and delivered; then the next stage steps. Passes over the stages
// are repeated until nobody is due at that instant.
//
// So the order of all messages of a run depends on the participants and what they publish alone, never on how
// long anything took or on who joined first.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/sim_time.h"

namespace halocline::bus {

// A participant's place in the schedule.
struct ScheduleEntry {
  int stage = 0;
  SimTime due = SimTime::never();
  bool has_input = false;  // messages that may advance its due instant: it steps at the present instant
  // It publishes nothing before this that another than a service may be made due by, unless it has input of
  // others than services. Before `due` it publishes nothing anyway.
  SimTime quiet_until = SimTime::at_once();
};

class LockstepSchedule {
 public:
  SimTime now() const { return now_; }

  // The earliest instant at which one is due, the present one at the earliest; never() when none is.
  // An entry with input is due at the present instant.
  SimTime next_instant(std::span<const ScheduleEntry> entries) const;
  // Time advances to `instant`, which is not before now().
  void begin(SimTime instant);
  // The entries of the next round at now(), all of one stage, as indices in rising order; empty when the
  // instant is over. `entries` are in rising order of stage. Throws std::runtime_error when an instant does
  // not end.
  std::vector<std::size_t> round(std::span<const ScheduleEntry> entries);
  // A participant of `stage` that stepped alone used its lookahead as far as `instant`, which continues with
  // the next stage.
  void resume_after(SimTime instant, int stage);

 private:
  SimTime now_;
  int next_stage_ = 0;
  int passes_ = 0;
};

// Lookahead of the entry that steps alone: it may step at all of its own instants before this one. A due
// instant is a promise to publish nothing before it unless a message is received, so until the earliest of
// the others is due nobody can publish anything that it would receive. at_once() when another has input.
SimTime lockstep_horizon(std::span<const ScheduleEntry> entries, std::size_t alone);

// Lookahead that the entries of one stage share: each may step at all of its own instants before this one,
// because until then none of the others is due, and none of the stage publishes what the rest of it receives.
// The present or earlier: there is none. It is kLongestSharedLookahead at most.
//
// A service (Stage::kTerrain) may be asked and may answer meanwhile. It publishes only what answers a
// message, at the instant of that message, to whom the message came from, so that others may have stepped
// beyond that instant.
inline constexpr SimDuration kLongestSharedLookahead = SimDuration::from_milliseconds(100);
SimTime shared_horizon(std::span<const ScheduleEntry> entries, int stage, SimTime now);

}  // namespace halocline::bus
