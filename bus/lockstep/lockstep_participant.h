// SPDX-License-Identifier: BSD-3-Clause
// Participant's side of the lockstep protocol (docs/architecture.md): joins, takes the granted turns, each
// once and in order, and answers. It is a state machine: messages and steady time in, messages out; no
// socket, no clock.
//
// Every grant carries the participant's incarnation and the number of its turn. If the turn is the next one,
// it is taken. If it is the last one taken, the stored answer is sent again. Any other is ignored. Grants may
// therefore be lost, duplicated or reordered, and each turn is still taken exactly once. Repeated grants that
// arrived while their turn was being taken are ignored, as the answer is already under way.
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
  // Time between JOINs until one is answered; afterwards, while no grant is received, kKeepAlivePeriod.
  static constexpr SimDuration kJoinPeriod = SimDuration::from_milliseconds(100);
  static constexpr SimDuration kKeepAlivePeriod = SimDuration::from_milliseconds(250);
  // Time limit for a participant that has taken its last turn: it continues to answer until the conductor
  // reports the end of the run, or is silent for this long.
  static constexpr SimDuration kLinger = SimDuration::from_milliseconds(60'000);

  struct Outputs {
    std::function<void(const lockstep_join_t&)> join;
    std::function<void(const lockstep_answer_t&)> answer;
  };
  using TakeTurn = std::function<lockstep_result_t(const lockstep_turn_t&)>;
  enum class State { kJoining, kTakingPart, kLeft, kOver, kExpelled };

  // `introduction`: LockstepTurns::introduction() with an incarnation. `take` throws errors that end the
  // participant.
  LockstepParticipant(lockstep_join_t introduction, TakeTurn take, Outputs outputs);

  void on_grant(const lockstep_grant_t& grant, SimTime steady);
  void on_notice(const lockstep_notice_t& notice, SimTime steady);
  // Call between two batches of messages: messages passed since the previous call had arrived before the
  // first of them was handled. Sends the JOIN that is due.
  void on_timer(SimTime steady);
  SimTime next_timer() const { return next_join_; }
  // Requests its last turn, with the next answer and with each JOIN.
  void request_leave();

  State state() const { return state_; }
  bool has_ended() const { return state_ == State::kOver || state_ == State::kExpelled; }
  // Reason for which it was expelled.
  const std::string& reason() const { return reason_; }
  // Simulation time of its last turn.
  SimTime reached() const { return reached_; }

 private:
  void take(const std::vector<lockstep_turn_t>& turns, std::int64_t first, bool past);
  void answer();
  void send_join();

  lockstep_join_t join_;
  TakeTurn take_;
  Outputs outputs_;
  State state_ = State::kJoining;
  std::string reason_;
  std::int64_t turns_taken_ = 0;
  SliceCollector grants_;
  Bytes last_result_;
  bool has_just_answered_ = false;  // since the last on_timer()
  SimTime next_join_, last_received_, reached_;
};

}  // namespace halocline::bus
