// SPDX-License-Identifier: BSD-3-Clause
// Sequencer of a lockstep run: a deterministic state machine for membership, step order, and the total order
// of all messages.
//
// The method is conservative synchronisation of a distributed discrete-event simulation (Chandy and Misra
// 1979): a participant steps only when no message that precedes the step can reach it any more. A participant
// that steps alone has lookahead to the earliest instant of the others, and those of one stage share
// lookahead (lockstep_schedule.h). Participants may then be ahead of now(): their messages are held back
// until nobody can publish an earlier one. The state is a function only of the inputs in order (members
// admitted, results of rounds, ...). Replaying a journal of the inputs therefore restores it, and the turns
// of a participant can be replayed to a new incarnation.
//
//   sequencer.admit(join);
//   while (sequencer.next_instant() <= end) {
//     sequencer.begin_instant(sequencer.next_instant());
//     while (sequencer.begin_round()) {
//       std::vector<lockstep_result_t> results;
//       for (const std::string& name : sequencer.round()) results.push_back(take(sequencer.turn_of(name)));
//       sequencer.complete(results);
//     }
//   }
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "bus/lockstep/lockstep_schedule.h"
#include "bus/messages/channel_pattern.h"
#include "bus/messages/messages.h"
#include "core/sim_time.h"

namespace halocline::conductor {

class Sequencer {
 public:
  // Number of steps in the result of a participant that was dropped. It takes no further part unless admitted
  // again.
  static constexpr std::int32_t kDropped = -1;

  // `publish` gets every message of the run, in order.
  explicit Sequencer(std::function<void(const lockstep_message_t&)> publish) : publish_(std::move(publish)) {}

  // ---- between rounds, when nobody is ahead of now()

  // True if nobody is ahead of now().
  bool is_level() const;
  // Admits a participant: at the start, late, or again after it was dropped or has left.
  void admit(const lockstep_join_t& join);
  // Makes the next round this participant's last turn, after which it takes no further part. Returns false if
  // it takes no part, or was dismissed already.
  bool dismiss(const std::string& name);
  // Accepts a message of a publisher outside the run; such messages are delivered, in the order given, at the
  // beginning of the next instant.
  void inject(lockstep_message_t message);
  // Makes every later round a last turn, at `instant`, in the order of stages.
  void end_run(SimTime instant);

  // ---- time and rounds

  SimTime now() const { return schedule_.now(); }
  // never() when nobody is due any more.
  SimTime next_instant() const;
  void begin_instant(SimTime instant);
  // Lookahead ends before this instant; at_once(): there is none.
  void set_furthest(SimTime furthest) { furthest_ = furthest; }
  // Returns false when the instant is over, or, after end_run(), when nobody is left.
  [[nodiscard]] bool begin_round();
  // Begins a round with the participants of a past round, given by its results; otherwise as begin_round().
  [[nodiscard]] bool begin_past_round(const std::vector<lockstep_result_t>& results);
  bool in_round() const { return !round_.empty(); }
  const std::vector<std::string>& round() const { return round_; }
  lockstep_turn_t turn_of(const std::string& name) const;
  // Instant of a turn of the round; lookahead() is the limit before which its steps are.
  SimTime instant_of(const std::string& name) const { return instant_of(*find(name)); }
  SimTime lookahead() const { return lookahead_; }
  // Takes one result for each participant of the round, in any order. Throws std::runtime_error when a
  // participant of the stage published before the time until which it promised to publish nothing, and
  // another is beyond that.
  void complete(std::vector<lockstep_result_t> results);

  // ---- history

  bool knows(const std::string& name) const { return find(name) != nullptr; }
  bool takes_part(const std::string& name) const;
  std::int64_t turns_taken(const std::string& name) const;
  std::int64_t digest_of(const std::string& name) const;
  // Returns turns already taken, from number `first` (counted from 1) on: as many as make about `bytes`, at
  // least one.
  std::vector<lockstep_turn_t> history_of(const std::string& name, std::int64_t first,
                                          std::size_t bytes) const;
  // Number of rounds completed, and of turns in them.
  std::int64_t rounds() const { return rounds_; }
  std::int64_t turns() const { return turns_; }

 private:
  struct Turn {
    std::int64_t instant_ns = 0, reached_ns = 0;
    std::int32_t steps = 0;
    std::size_t inbox_end = 0;  // number of messages delivered until then
  };
  struct Member {
    lockstep_join_t join;
    bus::ChannelPatterns patterns;
    // Families of channels that it receives, and of those whose messages may advance its due time.
    std::set<std::string> families, waking;
    // Families that must end its lookahead; true if only services receive them.
    std::map<std::string, bool> stopping;
    bus::ScheduleEntry schedule;
    SimTime reached = SimTime::at_once();  // in its last turn
    bool was_ahead = false;                // ahead of now() after its last turn
    bool present = true;
    std::vector<std::size_t> inbox;  // indices of all messages that it receives
    std::size_t delivered = 0;       // number of these in turns that it took
    std::vector<Turn> taken;
    std::int64_t digest = 0;
  };
  struct Receiver {
    Member* member;
    bool may_wake;
  };
  struct Held {
    lockstep_message_t message;
    const Member* publisher;
    SimTime instant() const { return SimTime::from_nanoseconds(message.instant_ns); }
  };

  Member* find(const std::string& name);
  const Member* find(const std::string& name) const;
  Member& add(const lockstep_join_t& join);
  std::vector<bus::ScheduleEntry> schedule_entries() const;
  const std::vector<Receiver>& receivers_of(const std::string& channel);
  void deliver(lockstep_message_t message);
  void take_result(Member& member, const lockstep_result_t& result);
  void note_members_changed();
  // Returns the instant of its next turn.
  SimTime instant_of(const Member& member) const { return std::max(now(), member.reached); }
  // Removes from the round participants that are due again at an instant to which they had stepped ahead of
  // the others; they wait for those.
  void leave_out_those_ahead(std::vector<std::size_t>& round);
  // Adds to the round those that share its lookahead; returns the lookahead.
  SimTime look_ahead(const std::vector<bus::ScheduleEntry>& all, std::vector<std::size_t>& round) const;
  void release();
  bool has_input() const {
    return std::any_of(members_.begin(), members_.end(),
                       [](const auto& member) { return member->present && member->schedule.has_input; });
  }
  SimTime safe() const;
  lockstep_turn_t turn_with_inputs(const Member& member, std::size_t begin, std::size_t end) const;
  std::map<std::string, bool> stopping_channels(const Member& of) const;
  bool shares_its_stage(const Member& member) const;

  std::function<void(const lockstep_message_t&)> publish_;
  std::vector<std::unique_ptr<Member>> members_;  // in the order of (stage, name)
  std::unordered_map<std::string, Member*> by_name_;
  bus::LockstepSchedule schedule_;
  SimTime furthest_ = SimTime::at_once();
  std::vector<std::string> round_;
  SimTime lookahead_ = SimTime::at_once();
  bool last_turn_ = false;  // the round consists of last turns
  std::vector<std::string> leaving_;
  bool ended_ = false;
  std::vector<lockstep_message_t> injected_;
  std::vector<Held> held_;  // in the order of the run
  std::vector<lockstep_message_t> messages_;
  std::unordered_map<std::string, std::vector<Receiver>> receivers_;  // keyed by channel
  std::int64_t rounds_ = 0, turns_ = 0;
};

}  // namespace halocline::conductor
