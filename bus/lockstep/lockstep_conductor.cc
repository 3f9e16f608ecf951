// SPDX-License-Identifier: BSD-3-Clause
#include "bus/lockstep/lockstep_conductor.h"

#include <algorithm>
#include <iterator>

#include "bus/lockstep/journal_replay.h"

namespace halocline::conductor {
namespace {

bus::Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

std::string at(SimTime sim) { return "t=" + std::to_string(sim.seconds()); }

lockstep_result_t dropped(const std::string& name) {
  lockstep_result_t result{};
  result.participant_name = name;
  result.num_steps = Sequencer::kDropped;
  return result;
}

// True if a turn can have this result: steps and messages in order of time, from the turn's instant to before
// its lookahead.
bool is_possible(const lockstep_result_t& result, SimTime instant, SimTime lookahead) {
  const std::int64_t end = std::max(lookahead, instant + SimDuration::from_nanoseconds(1)).nanoseconds();
  std::int64_t before = instant.nanoseconds();
  if (result.num_steps < 0 || result.reached_ns < before || result.reached_ns >= end) return false;
  for (const lockstep_message_t& message : result.outputs) {
    if (message.instant_ns < before || message.instant_ns > result.reached_ns) return false;
    before = message.instant_ns;
  }
  return true;
}

}  // namespace

LockstepConductor::LockstepConductor(LockstepRules rules, std::int64_t run_id, Outputs outputs)
    : rules_(std::move(rules)),
      run_{.id = run_id},
      outputs_(std::move(outputs)),
      sequencer_(outputs_.publish),
      grants_(sequencer_,
              [this](const std::string& channel, lockstep_grant_t& grant) {
                grant.run_id = run_.id;
                outputs_.grant(channel, grant);
              }),
      membership_(sequencer_, links_, grants_, rules_.agreement, {outputs_.notice, outputs_.report}) {}

void LockstepConductor::add_local(const lockstep_join_t& introduction, TakeTurn take) {
  ParticipantLink& link = links_.of(introduction.participant_name);
  link.join = introduction;
  link.join.incarnation = 1;  // not 0; a local participant has the conductor's incarnations
  link.take = std::move(take);
  link.up_to_date = true;
  link.wants_to_join = true;
}

void LockstepConductor::start() { record(EntryKind::kRun, bytes_of(std::to_string(run_.id))); }

void LockstepConductor::resume(const std::vector<JournalEntry>& entries) {
  run_ = replay_journal(entries, rules_.agreement, sequencer_);
  for (auto& [name, link] : links_) {
    if (!link.take) continue;
    link.wants_to_join = !sequencer_.knows(name);
    replay_local(link, sequencer_);
  }
  outputs_.report("resumed", at(sequencer_.now()) + " rounds=" + std::to_string(sequencer_.rounds()));
}

// ---- rounds

void LockstepConductor::advance(SimTime steady) {
  while (!run_.over && (running_ || begin_running())) {
    if (!sequencer_.in_round()) {
      if (!begin_next_round()) return;
      begin_exchange(steady);
    }
    if (!finish_round()) return;
  }
}

bool LockstepConductor::is_present(const std::string& name) const {
  const ParticipantLink* link = links_.find(name);
  return sequencer_.knows(name) || (link != nullptr && link->wants_to_join);
}

bool LockstepConductor::begin_running() {
  running_ = std::all_of(rules_.expected.begin(), rules_.expected.end(),
                         [this](const std::string& name) { return is_present(name); });
  return running_;
}

bool LockstepConductor::begin_next_round() {
  if (sequencer_.is_level()) {
    admit_and_dismiss();
    if (stop_requested_ && !run_.ending) end_at(sequencer_.now());
  }
  const SimTime after_end = rules_.end + SimDuration::from_nanoseconds(1);
  sequencer_.set_furthest(rules_.lookahead ? std::min(after_end, furthest_) : SimTime::at_once());
  while (!sequencer_.begin_round()) {
    if (run_.ending) {
      finish();
      return false;
    }
    if (!begin_next_instant()) return false;
  }
  return true;
}

bool LockstepConductor::begin_next_instant() {
  const SimTime next = sequencer_.next_instant();
  if (next > rules_.end) {
    end_at(rules_.end);
    return true;
  }
  if (next > furthest_) return false;
  auto injected = sequencer_.is_level() ? std::exchange(injected_, {}) : std::vector<lockstep_message_t>();
  for (lockstep_message_t& message : injected) {
    record(EntryKind::kInjected, bus::encoded(message));
    sequencer_.inject(std::move(message));
  }
  sequencer_.begin_instant(next);
  return true;
}

void LockstepConductor::admit_and_dismiss() {
  for (auto& [name, link] : links_) {
    if (link.wants_to_join && !run_.ending) {
      record(EntryKind::kJoin, bus::encoded(link.join));
      sequencer_.admit(link.join);
      link.wants_to_join = false;
      outputs_.report("joined", "participant=" + name + " " + at(sequencer_.now()));
    }
    if (std::exchange(link.wants_to_leave, false) && sequencer_.dismiss(name)) {
      record(EntryKind::kLeave, bytes_of(name));
      outputs_.report("leaves", "participant=" + name + " " + at(sequencer_.now()));
    }
  }
}

void LockstepConductor::end_at(SimTime instant) {
  record(EntryKind::kEnd, bytes_of(std::to_string(instant.nanoseconds())));
  sequencer_.end_run(instant);
  run_.ending = true;
}

void LockstepConductor::begin_exchange(SimTime steady) {
  round_began_ = steady;
  results_.clear();
  round_.clear();
  std::vector<ParticipantLink*> remote, local;
  for (const std::string& name : sequencer_.round()) {
    ParticipantLink& link = links_.of(name);
    round_.push_back(&link);
    link.awaited = true;
    if (link.take) {
      local.push_back(&link);
    } else if (link.up_to_date && link.incarnation != 0) {
      // An incarnation that joined after its predecessor had answered has not taken that turn.
      link.up_to_date = link.turns_taken >= sequencer_.turns_taken(name);
      if (link.up_to_date) {
        remote.push_back(&link);
      } else {
        grants_.grant_history(link, steady);
      }
    }
  }
  grants_.grant_turn(remote, steady);
  for (ParticipantLink* link : local) {  // meanwhile the remote ones take theirs
    results_.push_back(link->take(sequencer_.turn_of(link->name)));
    link->awaited = false;
  }
}

bool LockstepConductor::finish_round() {
  if (results_.size() < sequencer_.round().size()) return false;
  record(EntryKind::kRound, bus::encoded_list<lockstep_result_t>(results_));
  sequencer_.complete(std::exchange(results_, {}));
  for (ParticipantLink* link : round_) {
    if (sequencer_.takes_part(link->name) || link->incarnation == 0) continue;
    link->has_left = true;
    if (!run_.ending) membership_.notify(link->incarnation, run_, lockstep_notice_t::OVER);
  }
  return true;
}

void LockstepConductor::finish() {
  record(EntryKind::kOver, {});
  run_.over = true;
  for (const auto& [name, link] : links_) {
    if (link.incarnation != 0) membership_.notify(link.incarnation, run_, lockstep_notice_t::OVER);
  }
}

// ---- inputs

void LockstepConductor::on_join(const lockstep_join_t& join, SimTime steady) {
  advance(steady);  // after resume() the current round counts
  membership_.on_join(join, run_, steady);
  advance(steady);
}

void LockstepConductor::on_answer(const lockstep_answer_t& answer, SimTime steady) {
  ParticipantLink* link = links_.of_incarnation(answer.incarnation);
  if (link == nullptr || answer.run_id != run_.id) return;
  link->last_received = steady;
  link->wants_to_leave = link->wants_to_leave || answer.wants_to_leave != 0;
  const bool is_history = !link->up_to_date;
  if (!is_history && !link->awaited) return;
  if (answer.turn_number != grants_.first_turn(*link) + (is_history ? link->turns_granted - 1 : 0)) return;
  const auto body =
      link->answer.add(answer.turn_number, answer.slice_number, answer.slice_count, answer.slice_bytes);
  if (!body) return;
  auto result = bus::decoded<lockstep_result_t>(*body);
  if (!result || result->participant_name != link->name) return;
  if (!is_history && !is_possible(*result, sequencer_.instant_of(link->name), sequencer_.lookahead())) return;
  if (is_history) {
    membership_.on_history_taken(*link, *result, run_, steady);
  } else {
    link->timer.on_answered(steady);
    link->turns_taken = answer.turn_number;
    link->awaited = false;
    results_.push_back(std::move(*result));
  }
  advance(steady);
}

void LockstepConductor::on_timer(SimTime steady) {
  grants_.retransmit(links_, steady);
  drop_silent(steady);
  advance(steady);
}

void LockstepConductor::drop_silent(SimTime steady) {
  if (rules_.drop_after == SimDuration()) return;
  for (ParticipantLink* link : round_) {
    if (!link->awaited || steady < dropped_at(*link)) continue;
    outputs_.report("dropped", "participant=" + link->name + " " + at(sequencer_.now()) +
                                   " silent_s=" + std::to_string(rules_.drop_after.seconds()));
    links_.disconnect(*link);
    link->awaited = false;
    results_.push_back(dropped(link->name));
  }
}

SimTime LockstepConductor::dropped_at(const ParticipantLink& link) const {
  return std::max(round_began_, link.last_received) + rules_.drop_after;
}

SimTime LockstepConductor::next_timer() const {
  SimTime next = grants_.next_retransmission();
  if (rules_.drop_after == SimDuration() || !running_) return next;
  for (const ParticipantLink* link : round_) {
    if (link->awaited) next = std::min(next, dropped_at(*link));
  }
  return next;
}

std::vector<std::string> LockstepConductor::waiting_for() const {
  std::vector<std::string> names;
  if (!running_) {
    std::copy_if(rules_.expected.begin(), rules_.expected.end(), std::back_inserter(names),
                 [this](const std::string& name) { return !is_present(name); });
    return names;
  }
  for (const ParticipantLink* link : round_) {
    if (link->awaited) names.push_back(link->name);
  }
  return names;
}

}  // namespace halocline::conductor
