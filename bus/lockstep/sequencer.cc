#include "bus/lockstep/sequencer.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "core/check.h"

namespace halocline::conductor {
namespace {

template <class Seat>
auto order_of(const Seat& seat) {
  return std::tie(seat.join.step_stage, seat.join.participant_name);
}

}  // namespace

Sequencer::Seat* Sequencer::find(const std::string& name) {
  const auto seat = by_name_.find(name);
  return seat == by_name_.end() ? nullptr : seat->second;
}

const Sequencer::Seat* Sequencer::find(const std::string& name) const {
  const auto seat = by_name_.find(name);
  return seat == by_name_.end() ? nullptr : seat->second;
}

Sequencer::Seat& Sequencer::add_seat(const lockstep_join_t& join) {
  auto seat = std::make_unique<Seat>();
  seat->join = join;
  const auto after = std::upper_bound(seats_.begin(), seats_.end(), seat, [](const auto& a, const auto& b) {
    return order_of(*a) < order_of(*b);
  });
  return *(by_name_[join.participant_name] = seats_.insert(after, std::move(seat))->get());
}

void Sequencer::admit(const lockstep_join_t& join) {
  ensure(!in_round(), "participants are taken in between rounds");
  Seat* known = find(join.participant_name);
  Seat& seat = known != nullptr ? *known : add_seat(join);
  if (seat.taken.empty()) {
    seat.join = join;
    seat.patterns.clear();
    for (const std::string& expression : join.subscriptions) seat.patterns.emplace_back(expression);
    seat.place = {join.step_stage, SimTime::from_nanoseconds(join.next_due_ns)};
  }
  seat.present = true;
  hearers_.clear();
}

bool Sequencer::let_go(const std::string& name) {
  if (!takes_part(name) || std::find(leaving_.begin(), leaving_.end(), name) != leaving_.end()) return false;
  leaving_.push_back(name);
  return true;
}

void Sequencer::hear_from_outside(lockstep_message_t message) { outside_.push_back(std::move(message)); }

void Sequencer::end_run(SimTime instant) {
  schedule_.begin(std::max(instant, now()));
  ended_ = true;
}

std::vector<bus::LockstepSeat> Sequencer::places() const {
  std::vector<bus::LockstepSeat> places;
  for (const auto& seat : seats_)
    places.push_back(seat->present ? seat->place : bus::LockstepSeat{seat->place.stage});
  return places;
}

SimTime Sequencer::next_instant() const { return schedule_.next_instant(places()); }

void Sequencer::begin_instant(SimTime instant) {
  schedule_.begin(instant);
  for (lockstep_message_t& message : std::exchange(outside_, {})) {
    message.instant_ns = instant.nanoseconds();
    deliver(std::move(message));
  }
}

bool Sequencer::begin_round() {
  ensure(!in_round(), "a round is not over");
  farewell_ = ended_ || !leaving_.empty();
  horizon_ = SimTime::at_once();
  if (!leaving_.empty()) {
    round_ = {leaving_.front()};
    leaving_.erase(leaving_.begin());
  } else if (ended_) {
    const auto next =
        std::find_if(seats_.begin(), seats_.end(), [](const auto& seat) { return seat->present; });
    if (next != seats_.end()) round_ = {(*next)->join.participant_name};
  } else {
    const auto all = places();
    const auto chosen = schedule_.round(all);
    for (const std::size_t i : chosen) round_.push_back(seats_[i]->join.participant_name);
    if (chosen.size() == 1) horizon_ = std::min(bus::lockstep_horizon(all, chosen[0]), furthest_);
  }
  return in_round();
}

lockstep_turn_t Sequencer::bare_turn(const Seat& seat, std::size_t heard_from, std::size_t heard_end) const {
  lockstep_turn_t turn{};
  for (std::size_t i = heard_from; i < heard_end; ++i) turn.inputs.push_back(messages_[seat.heard[i]]);
  turn.num_inputs = static_cast<std::int32_t>(turn.inputs.size());
  return turn;
}

lockstep_turn_t Sequencer::turn_of(const std::string& name) const {
  const Seat& seat = *find(name);
  lockstep_turn_t turn = bare_turn(seat, seat.told, seat.heard.size());
  turn.instant_ns = now().nanoseconds();
  turn.horizon_ns = horizon_.nanoseconds();
  turn.max_steps = -1;
  turn.farewell = farewell_ ? 1 : 0;
  if (horizon_ > now()) turn.stopping_channels = stopping_channels(seat);
  turn.num_stopping = static_cast<std::int32_t>(turn.stopping_channels.size());
  return turn;
}

// What any other must hear at once.
std::vector<std::string> Sequencer::stopping_channels(const Seat& alone) const {
  std::set<std::string> expressions;
  for (const auto& seat : seats_) {
    if (seat.get() == &alone || !seat->present) continue;
    for (std::size_t i = 0; i < seat->patterns.size(); ++i) {
      if (seat->join.only_stores[i] == 0) expressions.insert(seat->join.subscriptions[i]);
    }
  }
  return {expressions.begin(), expressions.end()};
}

void Sequencer::complete(std::vector<lockstep_result_t> results) {
  ensure(results.size() == round_.size(), "a round is complete with one result of each");
  std::vector<std::pair<Seat*, lockstep_result_t*>> in_order;
  for (lockstep_result_t& result : results) in_order.emplace_back(find(result.participant_name), &result);
  std::sort(in_order.begin(), in_order.end(),
            [](const auto& a, const auto& b) { return order_of(*a.first) < order_of(*b.first); });
  for (const auto& [seat, result] : in_order) take_result(*seat, *result);
  for (const auto& [seat, result] : in_order) {
    for (lockstep_message_t& message : result->outputs) deliver(std::move(message));
  }
  const SimTime reached = SimTime::from_nanoseconds(results.front().reached_ns);
  if (results.size() == 1 && reached > now())
    schedule_.resume_after(reached, in_order.front().first->place.stage);
  round_.clear();
  ++rounds_;
}

void Sequencer::take_result(Seat& seat, const lockstep_result_t& result) {
  ++turns_;
  seat.place.must_hear = false;
  if (result.num_steps == kGivenUp) {
    seat.present = false;
    seat.heard.resize(seat.told);
    return;
  }
  seat.told = seat.heard.size();
  seat.place.due = SimTime::from_nanoseconds(result.next_due_ns);
  seat.digest = result.outputs_digest;
  seat.taken.push_back({now().nanoseconds(), result.reached_ns, result.num_steps, seat.told});
  if (!farewell_) return;
  seat.present = false;  // should it come back, it begins anew
  seat.taken.clear();
  seat.heard.clear();
  seat.told = 0;
}

void Sequencer::deliver(lockstep_message_t message) {
  const std::size_t index = messages_.size();
  messages_.push_back(std::move(message));
  const lockstep_message_t& kept = messages_.back();
  for (const Hearer& hearer : hearers_of(kept.channel_name)) {
    if (!hearer.seat->present) continue;
    hearer.seat->heard.push_back(index);
    if (hearer.may_wake) hearer.seat->place.must_hear = true;
  }
  said_(kept);
}

const std::vector<Sequencer::Hearer>& Sequencer::hearers_of(const std::string& channel) {
  const auto known = hearers_.find(channel);
  if (known != hearers_.end()) return known->second;
  std::vector<Hearer> hearers;
  for (const auto& seat : seats_) {
    bool hears = false, may_wake = false;
    for (std::size_t i = 0; i < seat->patterns.size(); ++i) {
      if (!seat->patterns[i].matches(channel)) continue;
      hears = true;
      may_wake = may_wake || seat->join.only_stores[i] == 0;
    }
    if (hears) hearers.push_back({seat.get(), may_wake});
  }
  return hearers_[channel] = std::move(hearers);
}

bool Sequencer::takes_part(const std::string& name) const {
  const Seat* seat = find(name);
  return seat != nullptr && seat->present;
}

std::int64_t Sequencer::turns_taken(const std::string& name) const {
  const Seat* seat = find(name);
  return seat == nullptr ? 0 : static_cast<std::int64_t>(seat->taken.size());
}

std::int64_t Sequencer::digest_of(const std::string& name) const { return find(name)->digest; }

std::vector<lockstep_turn_t> Sequencer::past_turns(const std::string& name, std::int64_t first,
                                                   std::size_t bytes) const {
  const Seat& seat = *find(name);
  std::vector<lockstep_turn_t> turns;
  std::size_t size = 0;
  for (auto i = static_cast<std::size_t>(first - 1); i < seat.taken.size() && size < bytes; ++i) {
    const Turn& taken = seat.taken[i];
    turns.push_back(bare_turn(seat, i == 0 ? 0 : seat.taken[i - 1].heard_end, taken.heard_end));
    turns.back().instant_ns = taken.instant_ns;
    turns.back().horizon_ns = taken.reached_ns + 1;
    turns.back().max_steps = taken.steps;
    size += static_cast<std::size_t>(turns.back().getEncodedSize()) + 4;
  }
  return turns;
}

}  // namespace halocline::conductor
