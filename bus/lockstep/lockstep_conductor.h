// The conductor's side of the lockstep protocol (docs/time.md): grants turns, repeats what is not answered, waits for
// or drops who is silent, and brings who comes back up to date. A state machine: messages and steady time in,
// messages and journal entries out; no socket, no file, no clock.
//
// Cost: a round is one grant (one datagram to all whose turns are alike, else one each) and one answer of each
// participant of the round. Repetitions go to those alone whose answer is missing.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bus/lockstep/journal.h"
#include "bus/lockstep/lockstep_wire.h"
#include "bus/lockstep/retransmission_timer.h"
#include "bus/lockstep/sequencer.h"

namespace halocline::conductor {

struct LockstepRules {
  std::set<std::string> expected;  // the run begins when all of these have joined
  SimTime end;                     // instants up to here, this one included
  // A participant that is waited for and silent for so long (steady time) is dropped; 0: it is waited for.
  SimDuration drop_after = SimDuration();
  std::string scenario_digest = {};  // of what participants must agree upon; empty: nothing is asked
  bool windows = true;               // participants may go on alone as far as causality allows
};

class LockstepConductor {
 public:
  struct Mouth {
    std::function<void(const std::string& channel, const lockstep_grant_t&)> grant;
    std::function<void(const lockstep_notice_t&)> notice;
    std::function<void(const JournalEntry&)> record;      // before anything that follows from it is said
    std::function<void(const lockstep_message_t&)> said;  // every message of the run, in order
    std::function<void(const std::string& event, const std::string& detail)> report;  // for a person
  };
  // Takes a turn of a participant that lives in this process.
  using TakeTurn = std::function<lockstep_result_t(const lockstep_turn_t&)>;

  LockstepConductor(LockstepRules rules, std::int64_t run_id, Mouth mouth);

  // Before start() or resume().
  void add_local(const lockstep_join_t& introduction, TakeTurn take);
  // A new run.
  void start();
  // Goes on where the journal of an earlier life ends. What is in it is not recorded again, but it is `said` again.
  void resume(const std::vector<JournalEntry>& entries);

  void on_join(const lockstep_join_t& join, SimTime steady);
  void on_answer(const lockstep_answer_t& answer, SimTime steady);
  // Something heard from who does not take part.
  void on_outside(lockstep_message_t message);
  // Goes on as far as possible without another answer; repeats and drops what is due.
  void on_timer(SimTime steady);
  SimTime next_timer() const;
  // Instants up to here may begin now; windows end before the next (paced runs).
  void set_pace(SimTime furthest) { furthest_ = furthest; }
  // Ends the run at the instant reached.
  void ask_to_stop() { stop_asked_ = true; }

  bool over() const { return over_; }
  std::int64_t run_id() const { return run_id_; }
  const Sequencer& sequencer() const { return sequencer_; }
  // Who is being waited for, by name; empty when nobody is.
  std::vector<std::string> waiting_for() const;
  std::int64_t repetitions() const { return repetitions_; }

 private:
  struct Link {
    std::int64_t life = 0;    // 0: none known
    bool up_to_date = false;  // has taken all turns of its name
    std::int64_t taken = 0;   // turns that this life has taken, as far as is known
    bool wants_to_leave = false;
    bool wants_in = false;      // to be admitted between rounds
    bool said_goodbye = false;  // this life has had its farewell
    lockstep_join_t join;
    TakeTurn take;  // lives in this process
    SimTime last_heard;
    RetransmissionTimer timer;
    bus::Bytes body;  // of the turns granted to it and not answered
    std::int32_t turns_in_body = 0;
    bus::SliceCollector answer;
    bool waited_for = false;  // in the round, and its result is not here
  };
  using NamedLink = std::pair<const std::string, Link>;

  // Joining
  bool is_past_taking_part(const lockstep_join_t& join) const;
  std::string objection_to(const lockstep_join_t& join, const Link& link) const;
  void adopt(const lockstep_join_t& join, NamedLink& named, SimTime steady);
  void go_on_with(NamedLink& named, SimTime steady);
  void tell_past(NamedLink& named, SimTime steady);
  void on_past_taken(NamedLink& named, const lockstep_result_t& result, SimTime steady);
  void put_out(std::int64_t life, const std::string& name, const std::string& reason) const;
  void notice(std::int64_t life, std::int8_t kind, const std::string& reason = "") const;

  // Rounds
  void advance(SimTime steady);
  bool begin_running();
  bool begin_next_round();
  bool begin_next_instant();
  void note_comings_and_goings();
  void end_at(SimTime instant);
  void begin_exchange(SimTime steady);
  bool finish_round();
  void finish();

  // Grants
  void prepare_turn(const std::string& name, Link& link);
  void say_grants(const std::vector<NamedLink*>& links, SimTime steady);
  void say_grant(std::span<NamedLink* const> links);
  std::int64_t first_turn_granted(const std::string& name, const Link& link) const;
  void repeat_unanswered(SimTime steady);
  void drop_silent(SimTime steady);
  SimTime dropped_at(const Link& link) const;

  void apply(const JournalEntry& entry);
  void apply_round(const bus::Bytes& bytes);
  void replay_local(const std::string& name, Link& link);
  void record(EntryKind kind, bus::Bytes bytes) const { mouth_.record({kind, std::move(bytes)}); }

  LockstepRules rules_;
  std::int64_t run_id_;
  Mouth mouth_;
  Sequencer sequencer_;
  std::map<std::string, Link> links_;
  std::map<std::int64_t, NamedLink*> link_of_life_;
  std::vector<NamedLink*> round_;  // of those in the sequencer's
  std::vector<lockstep_result_t> results_;
  std::vector<lockstep_message_t> outside_;
  SimTime furthest_ = SimTime::never();
  SimTime round_began_;                         // steady
  SimTime next_repetition_ = SimTime::never();  // steady; nothing is to be repeated before
  bool running_ = false, ending_ = false, over_ = false, stop_asked_ = false;
  std::int64_t repetitions_ = 0;
};

}  // namespace halocline::conductor
