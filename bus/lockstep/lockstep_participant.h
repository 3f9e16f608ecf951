// The participant's side of the lockstep protocol (docs/time.md): joins, takes the turns it is granted, once and in
// their order, and answers. A state machine: messages and steady time in, messages out; no socket, no clock.
//
// Every grant carries the participant's life and the number of its turn. The next turn is taken; the last one taken
// is answered again with the answer that was kept; any other is none of ours. So grants may be lost, repeated and
// overtaken, and each turn is taken exactly once.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bus/lockstep/lockstep_wire.h"
#include "core/sim_time.h"

namespace halocline::bus {

class LockstepParticipant {
 public:
  // How often an unanswered JOIN is said again, and how often one that waits for grants shows that it is there.
  static constexpr SimDuration kJoinPeriod = SimDuration::from_milliseconds(100);
  static constexpr SimDuration kShowPeriod = SimDuration::from_milliseconds(250);
  // After its farewell a participant still answers, until the conductor says that all is over, or for this long
  // without a word from it.
  static constexpr SimDuration kLinger = SimDuration::from_milliseconds(60'000);

  struct Mouth {
    std::function<void(const lockstep_join_t&)> join;
    std::function<void(const lockstep_answer_t&)> answer;
  };
  using TakeTurn = std::function<lockstep_result_t(const lockstep_turn_t&)>;
  enum class State { kJoining, kTakingPart, kLeft, kOver, kExpelled };

  // `introduction`: LockstepTurns::introduction with a life; `take` throws what ends the participant.
  LockstepParticipant(lockstep_join_t introduction, TakeTurn take, Mouth mouth);

  void on_grant(const lockstep_grant_t& grant, SimTime steady);
  void on_notice(const lockstep_notice_t& notice, SimTime steady);
  // Says what is due to be said again.
  void on_timer(SimTime steady);
  SimTime next_timer() const { return next_join_; }
  // Asks for a farewell: with the next answer, and as often as it shows itself.
  void ask_to_leave();

  State state() const { return state_; }
  bool has_ended() const { return state_ == State::kOver || state_ == State::kExpelled; }
  // Why it was put out.
  const std::string& reason() const { return reason_; }
  // Simulation time of its last turn.
  SimTime reached() const { return reached_; }

 private:
  void take(const std::vector<lockstep_turn_t>& turns, std::int64_t first, bool past);
  void answer();
  void say_where();

  lockstep_join_t join_;
  TakeTurn take_;
  Mouth mouth_;
  State state_ = State::kJoining;
  std::string reason_;
  std::int64_t turns_taken_ = 0;
  SliceCollector grants_;
  Bytes last_result_;
  SimTime next_join_, last_heard_, reached_;
};

}  // namespace halocline::bus
