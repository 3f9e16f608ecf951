#include "bus/lockstep/lockstep_conductor.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "bus/channels.h"
#include "core/check.h"

namespace halocline::conductor {
namespace {

bus::Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

std::string at(SimTime sim) { return "t=" + std::to_string(sim.seconds()); }

lockstep_result_t given_up(const std::string& name) {
  lockstep_result_t result{};
  result.participant_name = name;
  result.num_steps = Sequencer::kGivenUp;
  return result;
}

}  // namespace

LockstepConductor::LockstepConductor(LockstepRules rules, std::int64_t run_id, Mouth mouth)
    : rules_(std::move(rules)), run_id_(run_id), mouth_(std::move(mouth)), sequencer_(mouth_.said) {}

void LockstepConductor::add_local(const lockstep_join_t& introduction, TakeTurn take) {
  Link& link = links_[introduction.participant_name];
  link.join = introduction;
  link.join.incarnation = 1;  // it has no life of its own
  link.take = std::move(take);
  link.up_to_date = true;
  link.wants_in = true;
}

void LockstepConductor::start() { record(EntryKind::kRun, bytes_of(std::to_string(run_id_))); }

// ---- rounds

void LockstepConductor::advance(SimTime steady) {
  while (!over_ && (running_ || begin_running())) {
    if (!sequencer_.in_round()) {
      if (!begin_next_round()) return;
      begin_exchange(steady);
    }
    if (!finish_round()) return;
  }
}

bool LockstepConductor::begin_running() {
  const auto is_here = [this](const std::string& name) {
    const auto link = links_.find(name);
    return sequencer_.knows(name) || (link != links_.end() && link->second.wants_in);
  };
  running_ = std::all_of(rules_.expected.begin(), rules_.expected.end(), is_here);
  return running_;
}

bool LockstepConductor::begin_next_round() {
  note_comings_and_goings();
  if (stop_asked_ && !ending_) end_at(sequencer_.now());
  const SimTime after_end = rules_.end + SimDuration::from_nanoseconds(1);
  sequencer_.set_furthest(rules_.windows ? std::min(after_end, furthest_) : SimTime::at_once());
  while (!sequencer_.begin_round()) {
    if (ending_) return finish(), false;
    if (!begin_next_instant()) return false;
  }
  return true;
}

bool LockstepConductor::begin_next_instant() {
  const SimTime next = sequencer_.next_instant();
  if (next > rules_.end) return end_at(rules_.end), true;
  if (next > furthest_) return false;
  for (lockstep_message_t& message : std::exchange(outside_, {})) {
    record(EntryKind::kOutside, bus::encoded(message));
    sequencer_.hear_from_outside(std::move(message));
  }
  sequencer_.begin_instant(next);
  return true;
}

void LockstepConductor::note_comings_and_goings() {
  for (auto& [name, link] : links_) {
    if (link.wants_in && !ending_) {
      record(EntryKind::kJoin, bus::encoded(link.join));
      sequencer_.admit(link.join);
      link.wants_in = false;
      mouth_.report("joined", "participant=" + name + " " + at(sequencer_.now()));
    }
    if (std::exchange(link.wants_to_leave, false) && sequencer_.let_go(name)) {
      record(EntryKind::kFarewell, bytes_of(name));
      mouth_.report("leaves", "participant=" + name + " " + at(sequencer_.now()));
    }
  }
}

void LockstepConductor::end_at(SimTime instant) {
  record(EntryKind::kEnd, bytes_of(std::to_string(instant.nanoseconds())));
  sequencer_.end_run(instant);
  ending_ = true;
}

void LockstepConductor::begin_exchange(SimTime steady) {
  round_began_ = steady;
  results_.clear();
  round_.clear();
  std::vector<NamedLink*> remote, local;
  for (const std::string& name : sequencer_.round()) {
    NamedLink& named = *links_.try_emplace(name).first;
    Link& link = named.second;
    round_.push_back(&named);
    link.waited_for = true;
    if (link.take) {
      local.push_back(&named);
    } else if (link.up_to_date && link.life != 0) {
      // A life that came when its predecessor had answered lacks that turn.
      link.up_to_date = link.taken >= sequencer_.turns_taken(name);
      if (!link.up_to_date) {
        tell_past(named, steady);
        continue;
      }
      prepare_turn(name, link);
      remote.push_back(&named);
    }
  }
  say_grants(remote, steady);
  for (NamedLink* named : local) {
    results_.push_back(named->second.take(sequencer_.turn_of(named->first)));
    named->second.waited_for = false;
  }
}

bool LockstepConductor::finish_round() {
  if (results_.size() < sequencer_.round().size()) return false;
  record(EntryKind::kRound, bus::encoded_list<lockstep_result_t>(results_));
  sequencer_.complete(std::exchange(results_, {}));
  for (NamedLink* named : round_) {
    Link& link = named->second;
    if (sequencer_.takes_part(named->first) || link.life == 0) continue;
    link.said_goodbye = true;
    if (!ending_) notice(link.life, lockstep_notice_t::OVER);
  }
  return true;
}

void LockstepConductor::finish() {
  record(EntryKind::kOver, {});
  over_ = true;
  for (const auto& [name, link] : links_) {
    if (link.life != 0) notice(link.life, lockstep_notice_t::OVER);
  }
}

// ---- answers

void LockstepConductor::on_answer(const lockstep_answer_t& answer, SimTime steady) {
  const auto known = link_of_life_.find(answer.incarnation);
  if (known == link_of_life_.end() || answer.run_id != run_id_) return;
  auto& [name, link] = *known->second;
  link.last_heard = steady;
  link.wants_to_leave = link.wants_to_leave || answer.wants_to_leave != 0;
  const bool past = !link.up_to_date;
  if (!past && !link.waited_for) return;
  if (answer.turn_number != first_turn_granted(name, link) + (past ? link.turns_in_body - 1 : 0)) return;
  const auto body =
      link.answer.add(answer.turn_number, answer.slice_number, answer.slice_count, answer.slice_bytes);
  if (!body) return;
  auto result = bus::decoded<lockstep_result_t>(*body);
  if (!result || result->participant_name != name) return;
  if (past) {
    on_past_taken(*known->second, *result, steady);
  } else {
    link.timer.answered(steady);
    link.taken = answer.turn_number;
    link.waited_for = false;
    results_.push_back(std::move(*result));
  }
  advance(steady);
}

void LockstepConductor::on_outside(lockstep_message_t message) { outside_.push_back(std::move(message)); }

std::vector<std::string> LockstepConductor::waiting_for() const {
  std::vector<std::string> names;
  if (!running_) {
    for (const std::string& name : rules_.expected) {
      const auto link = links_.find(name);
      if (link == links_.end() || !(link->second.wants_in || sequencer_.knows(name))) names.push_back(name);
    }
    return names;
  }
  for (const NamedLink* named : round_) {
    if (named->second.waited_for) names.push_back(named->first);
  }
  return names;
}

// ---- grants

void LockstepConductor::prepare_turn(const std::string& name, Link& link) {
  link.body = bus::encoded_list<lockstep_turn_t>(std::array{sequencer_.turn_of(name)});
  link.turns_in_body = 1;
}

std::int64_t LockstepConductor::first_turn_granted(const std::string& name, const Link& link) const {
  return link.up_to_date ? sequencer_.turns_taken(name) + 1 : link.taken + 1;
}

// One grant for all whose turns are alike.
void LockstepConductor::say_grants(const std::vector<NamedLink*>& links, SimTime steady) {
  std::vector<NamedLink*> left = links;
  for (auto begin = left.begin(); begin != left.end();) {
    const Link& first = (*begin)->second;
    const auto others = std::stable_partition(begin, left.end(), [&](const NamedLink* named) {
      return named->second.up_to_date == first.up_to_date && named->second.body == first.body;
    });
    say_grant({begin, others});
    begin = others;
  }
  for (NamedLink* named : links) {
    named->second.timer.say(steady);
    next_repetition_ = std::min(next_repetition_, named->second.timer.again_at());
  }
}

void LockstepConductor::say_grant(std::span<NamedLink* const> links) {
  const Link& any = links.front()->second;
  lockstep_grant_t grant{};
  grant.run_id = run_id_;
  for (const NamedLink* named : links) {
    grant.incarnations.push_back(named->second.life);
    grant.first_turns.push_back(first_turn_granted(named->first, named->second));
  }
  grant.num_addressed = static_cast<std::int32_t>(links.size());
  grant.num_turns = any.turns_in_body;
  grant.past = any.up_to_date ? 0 : 1;
  grant.slice_count = bus::slice_count(any.body.size());
  std::string channel(bus::channels::kLockstepGrant);
  if (links.size() == 1) channel += "." + links.front()->first;
  for (grant.slice_number = 0; grant.slice_number < grant.slice_count; ++grant.slice_number) {
    const auto slice = bus::slice_of(any.body, grant.slice_number);
    grant.slice_bytes.assign(slice.begin(), slice.end());
    grant.num_slice_bytes = static_cast<std::int32_t>(slice.size());
    mouth_.grant(channel, grant);
  }
}

// ---- time

void LockstepConductor::on_timer(SimTime steady) {
  repeat_unanswered(steady);
  drop_silent(steady);
  advance(steady);
}

void LockstepConductor::repeat_unanswered(SimTime steady) {
  if (steady < next_repetition_) return;
  next_repetition_ = SimTime::never();
  std::vector<NamedLink*> unanswered;
  for (NamedLink& named : links_) {
    const auto& [name, link] = named;
    if (link.life == 0) continue;
    if (link.timer.again_at() <= steady) {
      unanswered.push_back(&named);
    } else {
      next_repetition_ = std::min(next_repetition_, link.timer.again_at());
    }
  }
  repetitions_ += static_cast<std::int64_t>(unanswered.size());
  say_grants(unanswered, steady);
}

void LockstepConductor::drop_silent(SimTime steady) {
  if (rules_.drop_after == SimDuration()) return;
  for (NamedLink* named : round_) {
    auto& [name, link] = *named;
    if (!link.waited_for || steady < dropped_at(link)) continue;
    mouth_.report("dropped", "participant=" + name + " " + at(sequencer_.now()) +
                                 " silent_s=" + std::to_string(rules_.drop_after.seconds()));
    link_of_life_.erase(link.life);
    link.life = 0;
    link.up_to_date = false;
    link.timer = {};
    link.waited_for = false;
    results_.push_back(given_up(name));
  }
}

SimTime LockstepConductor::dropped_at(const Link& link) const {
  return std::max(round_began_, link.last_heard) + rules_.drop_after;
}

SimTime LockstepConductor::next_timer() const {
  SimTime next = next_repetition_;
  if (rules_.drop_after == SimDuration() || !running_) return next;
  for (const NamedLink* named : round_) {
    if (named->second.waited_for) next = std::min(next, dropped_at(named->second));
  }
  return next;
}

}  // namespace halocline::conductor
