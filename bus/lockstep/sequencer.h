// SPDX-License-Identifier: BSD-3-Clause
// Deterministic state machine of a lockstep run: membership, step order, and the total order of all messages.
//
// Conservative synchronisation of a distributed discrete-event simulation (Chandy and Misra 1979): a
// participant steps only when no message can reach it any more that precedes the step; one that steps alone
// has lookahead to the earliest instant of the others, and those of one stage share lookahead
// (lockstep_schedule.h). Some are then ahead of now(): what they publish is held until nobody can publish
// anything that comes before it. The state is a function of the inputs in their order (members admitted,
// results of rounds, ...) and of nothing else. So replaying a journal of the inputs restores it, and the
// turns of a participant can be replayed to a new incarnation of it.
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

#include "bus/channel_pattern.h"
#include "bus/lockstep/lockstep_schedule.h"
#include "bus/messages.h"
#include "core/sim_time.h"

namespace halocline::conductor {

class Sequencer {
 public:
  // A result with this many steps: the participant was dropped. It takes no further part unless admitted
  // again.
  static constexpr std::int32_t kDropped = -1;

  // `publish` gets every message of the run, in order.
  explicit Sequencer(std::function<void(const lockstep_message_t&)> publish) : publish_(std::move(publish)) {}

  // ---- between rounds, when nobody is ahead

  // Whether nobody is.
  bool is_level() const;
  // Admits a participant: at the start, late, or again after it was dropped or has left.
  void admit(const lockstep_join_t& join);
  // The next round is this participant's last turn; then it takes no further part. False when it takes none,
  // or was dismissed already.
  bool dismiss(const std::string& name);
  // A message of a publisher outside the run: delivered, in the order given, at the beginning of the next
  // instant.
  void inject(lockstep_message_t message);
  // From here on every round is a last turn, at `instant`, in the order of stages.
  void end_run(SimTime instant);

  // ---- time and rounds

  SimTime now() const { return schedule_.now(); }
  // never() when nobody is due any more.
  SimTime next_instant() const;
  void begin_instant(SimTime instant);
  // Lookahead ends before this; at_once(): there is none.
  void set_furthest(SimTime furthest) { furthest_ = furthest; }
  // False when the instant is over, or, after end_run, when nobody is left.
  [[nodiscard]] bool begin_round();
  // As begin_round(), of those who have taken part in a round of the past: its results.
  [[nodiscard]] bool begin_past_round(const std::vector<lockstep_result_t>& results);
  bool in_round() const { return !round_.empty(); }
  const std::vector<std::string>& round() const { return round_; }
  lockstep_turn_t turn_of(const std::string& name) const;
  // Of a turn of the round: its instant, and before what its steps are.
  SimTime instant_of(const std::string& name) const { return instant_of(*find(name)); }
  SimTime horizon() const { return horizon_; }
  // One result for each of the round, in whatever order. Throws std::runtime_error when one of the stage
  // published before the instant until which it promised to be quiet, and another is beyond that.
  void complete(std::vector<lockstep_result_t> results);

  // ---- history

  bool knows(const std::string& name) const { return find(name) != nullptr; }
  bool takes_part(const std::string& name) const;
  std::int64_t turns_taken(const std::string& name) const;
  std::int64_t digest_of(const std::string& name) const;
  // Turns already taken, from number `first` (from 1) on; as many as make about `bytes`, one at least.
  std::vector<lockstep_turn_t> history_of(const std::string& name, std::int64_t first,
                                          std::size_t bytes) const;
  // Rounds completed, and turns within them.
  std::int64_t rounds() const { return rounds_; }
  std::int64_t turns() const { return turns_; }

 private:
  struct Turn {
    std::int64_t instant_ns = 0, reached_ns = 0;
    std::int32_t steps = 0;
    std::size_t inbox_end = 0;  // messages delivered until then
  };
  struct Member {
    lockstep_join_t join;
    bus::ChannelPatterns patterns;
    std::set<std::string> families,
        waking;  // of channels it receives; whose messages may advance its due instant
    std::map<std::string, bool>
        stopping;  // what must end its lookahead, and whether services alone receive it
    bus::ScheduleEntry schedule;
    SimTime reached = SimTime::at_once();  // in its last turn
    bool was_ahead = false;                // of now(), after that
    bool present = true;
    std::vector<std::size_t> inbox;  // indices of all messages that it receives
    std::size_t delivered = 0;       // of them, in turns that it took
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
  // The instant of its next turn.
  SimTime instant_of(const Member& member) const { return std::max(now(), member.reached); }
  // Those of them that are due again at an instant where they have stepped ahead of the others wait for
  // these.
  void leave_out_those_ahead(std::vector<std::size_t>& round);
  // Adds to the round those that share its lookahead; returns the horizon.
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
  SimTime horizon_ = SimTime::at_once();
  bool last_turn_ = false;  // the round is one of last turns
  std::vector<std::string> leaving_;
  bool ended_ = false;
  std::vector<lockstep_message_t> injected_;
  std::vector<Held> held_;  // in the order of the run
  std::vector<lockstep_message_t> messages_;
  std::unordered_map<std::string, std::vector<Receiver>> receivers_;  // by channel
  std::int64_t rounds_ = 0, turns_ = 0;
};

}  // namespace halocline::conductor
