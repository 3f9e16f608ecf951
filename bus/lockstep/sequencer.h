// What a run of lockstep is: who takes part, who steps next and hears what, and all messages in their order.
//
// A state machine without a network: its state is a function of what it was told (who was taken in, the results
// of each round, ...), in that order, and of nothing else. So a journal of what it was told brings it back, and the
// past of each participant can be told again to a new life of it. The rule is that of bus/lockstep/lockstep_schedule.h.
//
//   sequencer.admit(join); ...
//   while ((next = sequencer.next_instant()) <= end) {
//     sequencer.begin_instant(next);
//     while (sequencer.begin_round()) {
//       for (const std::string& name : sequencer.round()) results.push_back(take(sequencer.turn_of(name)));
//       sequencer.complete(results);
//     }
//   }
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "bus/channel_pattern.h"
#include "bus/lockstep/lockstep_schedule.h"
#include "bus/messages.h"

namespace halocline::conductor {

class Sequencer {
 public:
  // A result with this many steps: the participant was given up. It takes no further part unless admitted again.
  static constexpr std::int32_t kGivenUp = -1;

  // `said` gets every message of the run, in order.
  explicit Sequencer(std::function<void(const lockstep_message_t&)> said) : said_(std::move(said)) {}

  // ---- between rounds

  // Takes a participant in: at the start, late, or again after it was given up or has left.
  void admit(const lockstep_join_t& join);
  // The next round is this participant's farewell; then it takes no further part. False when it takes none, or was
  // let go already.
  bool let_go(const std::string& name);
  // Something said by nobody who takes part: heard, in the order given, at the beginning of the next instant.
  void hear_from_outside(lockstep_message_t message);
  // From here on every round is a farewell, at `instant`, in the order of stages.
  void end_run(SimTime instant);

  // ---- time and rounds

  SimTime now() const { return schedule_.now(); }
  // never() when nobody is due any more.
  SimTime next_instant() const;
  void begin_instant(SimTime instant);
  // Windows end before this; at_once(): there are none.
  void set_furthest(SimTime furthest) { furthest_ = furthest; }
  // False when the instant is over, or, after end_run, when nobody is left.
  bool begin_round();
  bool in_round() const { return !round_.empty(); }
  const std::vector<std::string>& round() const { return round_; }
  lockstep_turn_t turn_of(const std::string& name) const;
  // One result for each of the round, in whatever order.
  void complete(std::vector<lockstep_result_t> results);

  // ---- what has been

  bool knows(const std::string& name) const { return find(name) != nullptr; }
  bool takes_part(const std::string& name) const;
  std::int64_t turns_taken(const std::string& name) const;
  std::int64_t digest_of(const std::string& name) const;
  // Turns already taken, from number `first` (from 1) on, as they were; as many as make about `bytes`, one at least.
  std::vector<lockstep_turn_t> past_turns(const std::string& name, std::int64_t first,
                                          std::size_t bytes) const;
  // Rounds completed, and turns within them.
  std::int64_t rounds() const { return rounds_; }
  std::int64_t turns() const { return turns_; }

 private:
  struct Turn {
    std::int64_t instant_ns = 0, reached_ns = 0;
    std::int32_t steps = 0;
    std::size_t heard_end = 0;
  };
  struct Seat {
    lockstep_join_t join;
    std::vector<bus::ChannelPattern> patterns;
    bus::LockstepSeat place;
    bool present = true;
    std::vector<std::size_t> heard;  // indices of all messages meant for it
    std::size_t told = 0;            // how many of them it got in turns that it took
    std::vector<Turn> taken;
    std::int64_t digest = 0;
  };
  struct Hearer {
    Seat* seat;
    bool may_wake;
  };

  Seat* find(const std::string& name);
  const Seat* find(const std::string& name) const;
  Seat& add_seat(const lockstep_join_t& join);
  std::vector<bus::LockstepSeat> places() const;
  const std::vector<Hearer>& hearers_of(const std::string& channel);
  void deliver(lockstep_message_t message);
  void take_result(Seat& seat, const lockstep_result_t& result);
  lockstep_turn_t bare_turn(const Seat& seat, std::size_t heard_from, std::size_t heard_end) const;
  std::vector<std::string> stopping_channels(const Seat& alone) const;

  std::function<void(const lockstep_message_t&)> said_;
  std::vector<std::unique_ptr<Seat>> seats_;  // in the order of (stage, name)
  std::unordered_map<std::string, Seat*> by_name_;
  bus::LockstepSchedule schedule_;
  SimTime furthest_ = SimTime::at_once();
  std::vector<std::string> round_;
  SimTime horizon_ = SimTime::at_once();
  bool farewell_ = false;  // the round is one
  std::vector<std::string> leaving_;
  bool ended_ = false;
  std::vector<lockstep_message_t> outside_;
  std::vector<lockstep_message_t> messages_;
  std::unordered_map<std::string, std::vector<Hearer>> hearers_;
  std::int64_t rounds_ = 0, turns_ = 0;
};

}  // namespace halocline::conductor
