// SPDX-License-Identifier: BSD-3-Clause
// Conductor's side of the lockstep protocol (docs/architecture.md): executes the rounds of the sequencer by
// granting turns and collecting their results, in one or several incarnations of this process. It is a state
// machine: messages and steady time in, messages and journal entries out; no socket, no file, no clock.
//
// Cost: each round takes one grant (one datagram for all identical turns, otherwise one each) and one answer
// of each participant of the round.
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bus/lockstep/grant_sender.h"
#include "bus/lockstep/journal.h"
#include "bus/lockstep/lockstep_wire.h"
#include "bus/lockstep/membership.h"
#include "bus/lockstep/participant_links.h"
#include "bus/lockstep/sequencer.h"
#include "core/sim_time.h"

namespace halocline::conductor {

struct LockstepRules {
  std::set<std::string> expected;  // the run begins when all of these have joined
  SimTime end;                     // last instant of the run, inclusive
  // Silence (steady time) of an awaited participant after which it is dropped; 0: never.
  SimDuration drop_after = SimDuration();
  std::string agreement = {};  // text on which participants must agree (agreement.h); empty: none
  bool lookahead = true;       // a participant that steps alone may run ahead (lockstep_schedule.h)
};

class LockstepConductor {
 public:
  struct Outputs {
    std::function<void(const std::string& channel, const lockstep_grant_t&)> grant;
    std::function<void(const lockstep_notice_t&)> notice;
    std::function<void(const JournalEntry&)> record;  // called before anything that depends on it is sent
    std::function<void(const lockstep_message_t&)> publish;  // gets every message of the run, in order
    std::function<void(const std::string& event, const std::string& detail)> report;  // events for the user
  };

  LockstepConductor(LockstepRules rules, std::int64_t run_id, Outputs outputs);
  LockstepConductor(const LockstepConductor&) = delete;
  LockstepConductor& operator=(const LockstepConductor&) = delete;

  // Adds a participant of this process. Call before start() or resume(), or to join later.
  void add_local(const lockstep_join_t& introduction, TakeTurn take);
  void start();
  // Continues the run of a journal, whose messages are published again. Throws what replay_journal() throws.
  void resume(const std::vector<JournalEntry>& entries);

  void on_join(const lockstep_join_t& join, SimTime steady);
  void on_answer(const lockstep_answer_t& answer, SimTime steady);
  // Accepts a message of a publisher outside the run; it is delivered at the beginning of the next instant.
  void inject(lockstep_message_t message) { injected_.push_back(std::move(message)); }
  // Continues as far as possible without another answer; retransmits and drops participants when due.
  void on_timer(SimTime steady);
  SimTime next_timer() const;
  // Limits the run: instants up to `furthest` may begin now, and lookahead ends before the next one (paced
  // runs).
  void set_pace(SimTime furthest) { furthest_ = furthest; }
  // Ends the run at the instant reached.
  void request_stop() { stop_requested_ = true; }

  bool over() const { return run_.over; }
  const Sequencer& sequencer() const { return sequencer_; }
  // Returns the names of the participants that have not joined or answered.
  std::vector<std::string> waiting_for() const;
  std::int64_t retransmissions() const { return grants_.retransmissions(); }

 private:
  bool is_present(const std::string& name) const;
  void advance(SimTime steady);
  [[nodiscard]] bool begin_running();
  [[nodiscard]] bool begin_next_round();
  [[nodiscard]] bool begin_next_instant();
  void admit_and_dismiss();
  void end_at(SimTime instant);
  void begin_exchange(SimTime steady);
  [[nodiscard]] bool finish_round();
  void finish();
  void drop_silent(SimTime steady);
  SimTime dropped_at(const ParticipantLink& link) const;
  void record(EntryKind kind, bus::Bytes bytes) const { outputs_.record({kind, std::move(bytes)}); }

  LockstepRules rules_;
  RunState run_;
  Outputs outputs_;
  Sequencer sequencer_;
  ParticipantLinks links_;
  GrantSender grants_;
  Membership membership_;
  std::vector<ParticipantLink*> round_;  // links of the sequencer's round
  std::vector<lockstep_result_t> results_;
  std::vector<lockstep_message_t> injected_;
  SimTime furthest_ = SimTime::never();
  SimTime round_began_;  // steady
  bool running_ = false, stop_requested_ = false;
};

}  // namespace halocline::conductor
