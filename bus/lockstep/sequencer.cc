// SPDX-License-Identifier: BSD-3-Clause
#include "bus/lockstep/sequencer.h"

#include <stdexcept>
#include <tuple>

#include "bus/transport/node_identity.h"
#include "core/check.h"

namespace halocline::conductor {
namespace {

template <class Member>
auto order_of(const Member& member) {
  return std::tie(member.join.step_stage, member.join.participant_name);
}

constexpr int kServices = static_cast<int>(bus::Stage::kTerrain);

// Returns the expression of all channels of a family, so that the subscriptions to each vehicle's channel
// give one entry. An expression that is neither a channel nor a prefix is returned unchanged.
std::string family_of(const std::string& expression) {
  const bus::ChannelPattern pattern(expression);
  const bool is_text = !pattern.only_channel().empty() || !pattern.only_prefix().empty();
  const std::size_t dot = expression.find("\\.");
  return !is_text || dot == std::string::npos ? expression : expression.substr(0, dot + 2) + ".*";
}

}  // namespace

Sequencer::Member* Sequencer::find(const std::string& name) {
  const auto member = by_name_.find(name);
  return member == by_name_.end() ? nullptr : member->second;
}

const Sequencer::Member* Sequencer::find(const std::string& name) const {
  const auto member = by_name_.find(name);
  return member == by_name_.end() ? nullptr : member->second;
}

Sequencer::Member& Sequencer::add(const lockstep_join_t& join) {
  auto member = std::make_unique<Member>();
  member->join = join;
  const auto after =
      std::upper_bound(members_.begin(), members_.end(), member,
                       [](const auto& a, const auto& b) { return order_of(*a) < order_of(*b); });
  return *(by_name_[join.participant_name] = members_.insert(after, std::move(member))->get());
}

void Sequencer::admit(const lockstep_join_t& join) {
  ensure(!in_round(), "participants are admitted between rounds");
  Member* known = find(join.participant_name);
  Member& member = known != nullptr ? *known : add(join);
  if (member.taken.empty()) {
    member.join = join;
    member.patterns = {};
    member.families.clear();
    member.waking.clear();
    for (std::size_t i = 0; i < join.subscriptions.size(); ++i) {
      member.patterns.add(join.subscriptions[i]);
      member.families.insert(family_of(join.subscriptions[i]));
      if (join.only_stores[i] == 0) member.waking.insert(family_of(join.subscriptions[i]));
    }
    member.schedule = {join.step_stage, SimTime::from_nanoseconds(join.next_due_ns)};
    member.reached = SimTime::at_once();
  }
  member.present = true;
  note_members_changed();
}

void Sequencer::note_members_changed() {
  receivers_.clear();
  for (const auto& member : members_) {
    member->stopping.clear();
    member->schedule.lookahead = SimTime::at_once();  // the promise was made to the previous members
  }
}

bool Sequencer::is_level() const {
  return held_.empty() && std::none_of(members_.begin(), members_.end(), [this](const auto& member) {
           return member->present && member->reached > now();
         });
}

bool Sequencer::dismiss(const std::string& name) {
  if (!takes_part(name) || std::find(leaving_.begin(), leaving_.end(), name) != leaving_.end()) return false;
  leaving_.push_back(name);
  return true;
}

void Sequencer::inject(lockstep_message_t message) { injected_.push_back(std::move(message)); }

void Sequencer::end_run(SimTime instant) {
  schedule_.begin(std::max(instant, now()));
  ended_ = true;
}

std::vector<bus::ScheduleEntry> Sequencer::schedule_entries() const {
  std::vector<bus::ScheduleEntry> entries;
  for (const auto& member : members_)
    entries.push_back(member->present ? member->schedule
                                      : bus::ScheduleEntry{.stage = member->schedule.stage});
  return entries;
}

SimTime Sequencer::next_instant() const { return schedule_.next_instant(schedule_entries()); }

void Sequencer::begin_instant(SimTime instant) {
  schedule_.begin(instant);
  for (lockstep_message_t& message : std::exchange(injected_, {})) {
    message.instant_ns = instant.nanoseconds();
    deliver(std::move(message));
  }
}

bool Sequencer::begin_round() {
  ensure(!in_round(), "a round is not over");
  last_turn_ = ended_ || !leaving_.empty();
  lookahead_ = SimTime::at_once();
  if (!leaving_.empty()) {
    round_ = {leaving_.front()};
    leaving_.erase(leaving_.begin());
  } else if (ended_) {
    const auto next =
        std::find_if(members_.begin(), members_.end(), [](const auto& member) { return member->present; });
    if (next != members_.end()) round_ = {(*next)->join.participant_name};
  } else {
    const auto all = schedule_entries();
    auto chosen = schedule_.round(all);
    leave_out_those_ahead(chosen);
    if (!chosen.empty()) lookahead_ = look_ahead(all, chosen);
    for (const std::size_t i : chosen) {
      Member& member = *members_[i];
      if (member.stopping.empty()) member.stopping = stopping_channels(member);
      round_.push_back(member.join.participant_name);
    }
  }
  return in_round();
}

bool Sequencer::begin_past_round(const std::vector<lockstep_result_t>& results) {
  if (!begin_round()) return false;
  round_.clear();
  for (const lockstep_result_t& result : results) round_.push_back(result.participant_name);
  return true;
}

void Sequencer::leave_out_those_ahead(std::vector<std::size_t>& round) {
  const auto others = std::stable_partition(round.begin(), round.end(), [this](std::size_t i) {
    return !std::exchange(members_[i]->was_ahead, false) || members_[i]->reached < now();
  });
  if (others != round.begin()) round.erase(others, round.end());
}

// While messages are held back, a participant that steps alone is limited to the shared lookahead, too: the
// others may be waiting for a service.
SimTime Sequencer::look_ahead(const std::vector<bus::ScheduleEntry>& all,
                              std::vector<std::size_t>& round) const {
  const int stage = all[round.front()].stage;
  const SimTime shared = std::min(bus::shared_lookahead(all, stage, now()), furthest_);
  if (shared > now()) {
    std::vector<std::size_t> sharing;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].stage == stage && all[i].due < shared) sharing.push_back(i);
    }
    if (sharing.size() > 1) round = std::move(sharing);
  }
  if (round.size() > 1 || !held_.empty()) return shared;
  return std::min(bus::lookahead_alone(all, round.front()), furthest_);
}

lockstep_turn_t Sequencer::turn_with_inputs(const Member& member, std::size_t begin, std::size_t end) const {
  lockstep_turn_t turn{};
  for (std::size_t i = begin; i < end; ++i) turn.inputs.push_back(messages_[member.inbox[i]]);
  turn.num_inputs = static_cast<std::int32_t>(turn.inputs.size());
  return turn;
}

lockstep_turn_t Sequencer::turn_of(const std::string& name) const {
  const Member& member = *find(name);
  lockstep_turn_t turn = turn_with_inputs(member, member.delivered, member.inbox.size());
  turn.instant_ns = instant_of(member).nanoseconds();
  turn.lookahead_ns = lookahead_.nanoseconds();
  turn.max_steps = -1;
  turn.farewell = last_turn_ ? 1 : 0;
  if (lookahead_ > now() || shares_its_stage(member)) {
    for (const auto& [family, only_asks] : member.stopping) {
      turn.stopping_channels.push_back(family);
      turn.only_asks.push_back(only_asks ? 1 : 0);
    }
  }
  turn.num_stopping = static_cast<std::int32_t>(turn.stopping_channels.size());
  return turn;
}

// Returns families that may wake another participant, and everything that others of its stage receive.
// Families keep the list short, as each turn carries it.
std::map<std::string, bool> Sequencer::stopping_channels(const Member& of) const {
  std::map<std::string, bool> families;
  for (const auto& member : members_) {
    if (member.get() == &of || !member->present) continue;
    const bool is_service = member->schedule.stage == kServices;
    const bool is_mate = member->schedule.stage == of.schedule.stage;
    for (const std::string& family : is_mate ? member->families : member->waking) {
      const auto [known, is_new] = families.try_emplace(family, is_service);
      known->second = known->second && is_service;
    }
  }
  return families;
}

bool Sequencer::shares_its_stage(const Member& member) const {
  return std::any_of(members_.begin(), members_.end(), [&](const auto& other) {
    return other.get() != &member && other->present && other->schedule.stage == member.schedule.stage;
  });
}

void Sequencer::complete(std::vector<lockstep_result_t> results) {
  ensure(results.size() == round_.size(), "a round is complete with one result of each");
  std::vector<std::pair<Member*, lockstep_result_t*>> in_order;
  for (lockstep_result_t& result : results) in_order.emplace_back(find(result.participant_name), &result);
  std::sort(in_order.begin(), in_order.end(),
            [](const auto& a, const auto& b) { return order_of(*a.first) < order_of(*b.first); });
  for (const auto& [member, result] : in_order) take_result(*member, *result);
  for (const auto& [member, result] : in_order) {
    for (lockstep_message_t& message : result->outputs) held_.push_back({std::move(message), member});
  }
  std::stable_sort(held_.begin(), held_.end(), [](const Held& a, const Held& b) {
    return a.message.instant_ns != b.message.instant_ns ? a.message.instant_ns < b.message.instant_ns
                                                        : order_of(*a.publisher) < order_of(*b.publisher);
  });
  round_.clear();
  ++rounds_;
  release();
  const Member& any = *in_order.front().first;
  SimTime reached = any.reached;
  for (const auto& [member, result] : in_order) reached = std::max(reached, member->reached);
  reached = std::min(reached, safe());
  if (held_.empty() && !has_input() && reached > now()) schedule_.resume_after(reached, any.schedule.stage);
  for (const auto& [member, result] : in_order) member->was_ahead = member->reached > now();
}

// Delivers held messages in the order of the run, instant by instant, as long as no participant can publish
// an earlier message, and none has been woken that might do so.
void Sequencer::release() {
  const SimTime safe_until = safe();
  auto next = held_.begin();
  while (next != held_.end()) {
    const SimTime instant = next->instant();
    if (instant > now() && (instant > safe_until || has_input())) break;
    if (instant > now()) schedule_.resume_after(instant, next->publisher->schedule.stage);
    for (; next != held_.end() && next->instant() == instant; ++next) deliver(std::move(next->message));
  }
  held_.erase(held_.begin(), next);
}

// Returns the last instant at which nobody has another step, except in another pass at that instant.
SimTime Sequencer::safe() const {
  SimTime safe = SimTime::never();
  for (const auto& member : members_) {
    if (!member->present) continue;
    const SimTime due = member->schedule.due;
    safe = std::min(safe, due > member->reached ? due - SimDuration::from_nanoseconds(1) : due);
  }
  return safe;
}

void Sequencer::take_result(Member& member, const lockstep_result_t& result) {
  ++turns_;
  member.schedule.has_input = false;
  if (result.num_steps == kDropped) {
    member.present = false;
    member.inbox.resize(member.delivered);
    return note_members_changed();
  }
  member.delivered = member.inbox.size();
  member.schedule.due = SimTime::from_nanoseconds(result.next_due_ns);
  member.digest = result.outputs_digest;
  member.taken.push_back(
      {instant_of(member).nanoseconds(), result.reached_ns, result.num_steps, member.delivered});
  member.reached = SimTime::from_nanoseconds(result.reached_ns);
  // If it is due again at the instant of its step, those that share its lookahead must not pass that instant.
  const bool is_due_again = member.schedule.due <= member.reached;
  member.schedule.lookahead =
      is_due_again ? SimTime::at_once() : SimTime::from_nanoseconds(result.lookahead_ns);
  if (!last_turn_) return;
  note_members_changed();
  member.present = false;  // if it returns, it begins again
  member.taken.clear();
  member.inbox.clear();
  member.delivered = 0;
}

void Sequencer::deliver(lockstep_message_t message) {
  const std::size_t index = messages_.size();
  messages_.push_back(std::move(message));
  const lockstep_message_t& kept = messages_.back();
  for (const Receiver& receiver : receivers_of(kept.channel_name)) {
    if (!receiver.member->present) continue;
    if (receiver.member->reached.nanoseconds() > kept.instant_ns) {
      throw std::runtime_error(
          kept.channel_name +
          " was published at t=" + std::to_string(1e-9 * static_cast<double>(kept.instant_ns)) +
          " s, before the instant that its publisher promised to " + receiver.member->join.participant_name);
    }
    receiver.member->inbox.push_back(index);
    if (receiver.may_wake) receiver.member->schedule.has_input = true;
  }
  publish_(kept);
}

const std::vector<Sequencer::Receiver>& Sequencer::receivers_of(const std::string& channel) {
  const auto known = receivers_.find(channel);
  if (known != receivers_.end()) return known->second;
  std::vector<Receiver> receivers;
  for (const auto& member : members_) {
    const auto matching = member->patterns.matching(channel);
    const bool may_wake = std::any_of(matching.begin(), matching.end(),
                                      [&](std::size_t i) { return member->join.only_stores[i] == 0; });
    if (!matching.empty()) receivers.push_back({member.get(), may_wake});
  }
  return receivers_[channel] = std::move(receivers);
}

bool Sequencer::takes_part(const std::string& name) const {
  const Member* member = find(name);
  return member != nullptr && member->present;
}

std::int64_t Sequencer::turns_taken(const std::string& name) const {
  const Member* member = find(name);
  return member == nullptr ? 0 : static_cast<std::int64_t>(member->taken.size());
}

std::int64_t Sequencer::digest_of(const std::string& name) const { return find(name)->digest; }

std::vector<lockstep_turn_t> Sequencer::history_of(const std::string& name, std::int64_t first,
                                                   std::size_t bytes) const {
  const Member& member = *find(name);
  std::vector<lockstep_turn_t> turns;
  std::size_t size = 0;
  for (auto i = static_cast<std::size_t>(first - 1); i < member.taken.size() && size < bytes; ++i) {
    const Turn& taken = member.taken[i];
    turns.push_back(turn_with_inputs(member, i == 0 ? 0 : member.taken[i - 1].inbox_end, taken.inbox_end));
    turns.back().instant_ns = taken.instant_ns;
    turns.back().lookahead_ns = taken.reached_ns + 1;
    turns.back().max_steps = taken.steps;
    size += static_cast<std::size_t>(turns.back().getEncodedSize()) + 4;
  }
  return turns;
}

}  // namespace halocline::conductor
