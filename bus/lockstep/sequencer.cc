#include "bus/lockstep/sequencer.h"

#include <algorithm>
#include <tuple>

#include "core/check.h"

namespace halocline::conductor {
namespace {

template <class Member>
auto order_of(const Member& member) {
  return std::tie(member.join.step_stage, member.join.participant_name);
}

// All channels of the family that an expression belongs to: subscriptions to each vehicle's channel make one.
std::string family_of(const std::string& expression) {
  const std::size_t dot = expression.find("\\.");
  return dot == std::string::npos ? expression : expression.substr(0, dot + 2) + ".*";
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
    member.waking.clear();
    for (std::size_t i = 0; i < join.subscriptions.size(); ++i) {
      member.patterns.add(join.subscriptions[i]);
      if (join.only_stores[i] == 0) member.waking.insert(family_of(join.subscriptions[i]));
    }
    member.schedule = {join.step_stage, SimTime::from_nanoseconds(join.next_due_ns)};
  }
  member.present = true;
  receivers_.clear();
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
    entries.push_back(member->present ? member->schedule : bus::ScheduleEntry{member->schedule.stage});
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
  horizon_ = SimTime::at_once();
  if (!leaving_.empty()) {
    round_ = {leaving_.front()};
    leaving_.erase(leaving_.begin());
  } else if (ended_) {
    const auto next =
        std::find_if(members_.begin(), members_.end(), [](const auto& member) { return member->present; });
    if (next != members_.end()) round_ = {(*next)->join.participant_name};
  } else {
    const auto all = schedule_entries();
    const auto chosen = schedule_.round(all);
    for (const std::size_t i : chosen) round_.push_back(members_[i]->join.participant_name);
    if (chosen.size() == 1) horizon_ = std::min(bus::lockstep_horizon(all, chosen[0]), furthest_);
  }
  return in_round();
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
  turn.instant_ns = now().nanoseconds();
  turn.horizon_ns = horizon_.nanoseconds();
  turn.max_steps = -1;
  turn.farewell = last_turn_ ? 1 : 0;
  if (horizon_ > now()) turn.stopping_channels = stopping_channels(member);
  turn.num_stopping = static_cast<std::int32_t>(turn.stopping_channels.size());
  return turn;
}

// What may wake one of the others ends the lookahead of the one that steps alone; by family, for each turn has the list.
std::vector<std::string> Sequencer::stopping_channels(const Member& alone) const {
  std::set<std::string> expressions;
  for (const auto& member : members_) {
    if (member.get() != &alone && member->present)
      expressions.insert(member->waking.begin(), member->waking.end());
  }
  return {expressions.begin(), expressions.end()};
}

void Sequencer::complete(std::vector<lockstep_result_t> results) {
  ensure(results.size() == round_.size(), "a round is complete with one result of each");
  std::vector<std::pair<Member*, lockstep_result_t*>> in_order;
  for (lockstep_result_t& result : results) in_order.emplace_back(find(result.participant_name), &result);
  std::sort(in_order.begin(), in_order.end(),
            [](const auto& a, const auto& b) { return order_of(*a.first) < order_of(*b.first); });
  for (const auto& [member, result] : in_order) take_result(*member, *result);
  for (const auto& [member, result] : in_order) {
    for (lockstep_message_t& message : result->outputs) deliver(std::move(message));
  }
  const SimTime reached = SimTime::from_nanoseconds(results.front().reached_ns);
  if (results.size() == 1 && reached > now())
    schedule_.resume_after(reached, in_order.front().first->schedule.stage);
  round_.clear();
  ++rounds_;
}

void Sequencer::take_result(Member& member, const lockstep_result_t& result) {
  ++turns_;
  member.schedule.has_input = false;
  if (result.num_steps == kDropped) {
    member.present = false;
    member.inbox.resize(member.delivered);
    return;
  }
  member.delivered = member.inbox.size();
  member.schedule.due = SimTime::from_nanoseconds(result.next_due_ns);
  member.digest = result.outputs_digest;
  member.taken.push_back({now().nanoseconds(), result.reached_ns, result.num_steps, member.delivered});
  if (!last_turn_) return;
  member.present = false;  // should it come back, it begins anew
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
    turns.back().horizon_ns = taken.reached_ns + 1;
    turns.back().max_steps = taken.steps;
    size += static_cast<std::size_t>(turns.back().getEncodedSize()) + 4;
  }
  return turns;
}

}  // namespace halocline::conductor
