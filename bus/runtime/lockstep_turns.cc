// SPDX-License-Identifier: BSD-3-Clause
#include "bus/runtime/lockstep_turns.h"

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include "bus/lockstep/lockstep_wire.h"
#include "bus/transport/subscription.h"

namespace halocline::bus {
namespace {

// Limits on the lookahead of one turn; they keep its result near the size of a datagram.
constexpr int kMaxStepsPerTurn = 1000;
constexpr std::size_t kMaxPublishedPerTurn = 200;

}  // namespace

LockstepTurns::LockstepTurns(Node& node) : node_(node) {
  node_.set_outbox([this](std::string_view channel, const void* data, std::size_t size) {
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    lockstep_message_t message;
    message.instant_ns = now_.nanoseconds();
    message.channel_name = channel;
    message.num_message_bytes = static_cast<std::int32_t>(size);
    message.message_bytes.assign(bytes, bytes + size);
    published_.push_back(std::move(message));
  });
}

lockstep_join_t LockstepTurns::introduction() const {
  lockstep_join_t join{};
  join.participant_name = node_.name();
  join.step_stage = static_cast<std::int32_t>(node_.stage());
  join.next_due_ns = node_.lockstep_due().nanoseconds();
  for (const Subscribed& subscribed : node_.subscribed()) {
    join.subscriptions.push_back(subscribed.expression);
    join.only_stores.push_back(subscribed.wakeup == Wakeup::kStoreOnly ? 1 : 0);
  }
  join.num_subscriptions = static_cast<std::int32_t>(join.subscriptions.size());
  return join;
}

LockstepTurns::Interest LockstepTurns::interest_in(const std::string& channel) {
  const auto known = interests_.find(channel);
  if (known != interests_.end()) return known->second;
  Interest interest;
  for (const std::size_t i : node_.subscribed_to(channel)) {
    interest.receives = true;
    interest.may_wake = interest.may_wake || node_.subscribed()[i].wakeup == Wakeup::kMayAdvanceDue;
  }
  return interests_[channel] = interest;
}

void LockstepTurns::deliver(const std::vector<lockstep_message_t>& messages) {
  if (messages.empty()) return;
  const SimTime due = node_.lockstep_due();
  bool may_wake = false;
  for (const lockstep_message_t& message : messages) {
    node_.receive(message.channel_name, message.message_bytes);
    may_wake = may_wake || interest_in(message.channel_name).may_wake;
  }
  if (!may_wake) node_.note_due_changed();  // recompute it: the promise may be broken
  if (!may_wake && node_.lockstep_due() < due)
    throw std::logic_error(node_.name() + " became due by a message that it promised only to store");
}

bool LockstepTurns::must_pause(const lockstep_turn_t& turn, std::size_t published_before) {
  for (std::size_t i = published_before; i < published_.size(); ++i) {
    const std::string& channel = published_[i].channel_name;
    if (interest_in(channel).receives) return true;
    for (const std::string& expression : turn.stopping_channels) {
      if (pattern_of(expression).matches(channel)) return true;
    }
  }
  return published_.size() >= kMaxPublishedPerTurn;
}

const ChannelPattern& LockstepTurns::pattern_of(const std::string& expression) {
  return stopping_.try_emplace(expression, expression).first->second;
}

SimTime LockstepTurns::lookahead(const lockstep_turn_t& turn) {
  return node_.lookahead([&](std::string_view channel) {
    for (std::size_t i = 0; i < turn.stopping_channels.size(); ++i) {
      if (turn.only_asks[i] == 0 && pattern_of(turn.stopping_channels[i]).matches(channel)) return true;
    }
    return false;
  });
}

lockstep_result_t LockstepTurns::take(const lockstep_turn_t& turn) {
  published_.clear();
  now_ = SimTime::from_nanoseconds(turn.instant_ns);
  const SimTime lookahead_end = SimTime::from_nanoseconds(turn.lookahead_ns);
  const int max_steps = turn.max_steps >= 0 ? turn.max_steps : kMaxStepsPerTurn;
  deliver(turn.inputs);
  if (turn.farewell != 0) node_.stop({now_, now_});
  int steps = 0;
  for (bool paused = turn.farewell != 0; !paused && steps < max_steps; ++steps) {
    const SimTime next = std::max(node_.lockstep_due(), now_);
    const bool at_instant = steps == 0 && next == now_;
    if (!at_instant && next >= lookahead_end) break;
    const std::size_t published_before = published_.size();
    now_ = next;
    node_.step({now_, now_});
    paused = must_pause(turn, published_before) || node_.lockstep_due() <= now_;
  }
  digest_ = digest_of(digest_, published_);
  lockstep_result_t result;
  result.participant_name = node_.name();
  result.num_steps = steps;
  result.reached_ns = now_.nanoseconds();
  result.next_due_ns = node_.lockstep_due().nanoseconds();
  result.lookahead_ns = lookahead(turn).nanoseconds();
  result.outputs_digest = digest_;
  result.num_outputs = static_cast<std::int32_t>(published_.size());
  result.outputs = published_;
  return result;
}

}  // namespace halocline::bus
