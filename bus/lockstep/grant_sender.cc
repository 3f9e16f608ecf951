// SPDX-License-Identifier: BSD-3-Clause
#include "bus/lockstep/grant_sender.h"

#include <algorithm>
#include <array>

#include "bus/messages/channels.h"
namespace halocline::conductor {
namespace {

// Amount of history in one grant: about one slice.
constexpr std::size_t kHistoryBytesPerGrant = 40'000;

}  // namespace

void GrantSender::grant_turn(const std::vector<ParticipantLink*>& links, SimTime steady) {
  for (ParticipantLink* link : links) {
    link->granted = bus::encoded_list<lockstep_turn_t>(std::array{sequencer_.turn_of(link->name)});
    link->turns_granted = 1;
  }
  send(links, steady);
}

void GrantSender::grant_history(ParticipantLink& link, SimTime steady) {
  const auto turns = sequencer_.history_of(link.name, link.turns_taken + 1, kHistoryBytesPerGrant);
  link.granted = bus::encoded_list<lockstep_turn_t>(turns);
  link.turns_granted = static_cast<std::int32_t>(turns.size());
  send({&link}, steady);
}

std::int64_t GrantSender::first_turn(const ParticipantLink& link) const {
  return (link.up_to_date ? sequencer_.turns_taken(link.name) : link.turns_taken) + 1;
}

void GrantSender::send(const std::vector<ParticipantLink*>& links, SimTime steady) {
  std::vector<ParticipantLink*> left = links;
  for (auto begin = left.begin(); begin != left.end();) {
    const ParticipantLink& first = **begin;
    const auto others = std::stable_partition(begin, left.end(), [&](const ParticipantLink* link) {
      return link->up_to_date == first.up_to_date && link->granted == first.granted;
    });
    send_one({begin, others});
    begin = others;
  }
  for (ParticipantLink* link : links) {
    link->timer.on_sent(steady);
    next_retransmission_ = std::min(next_retransmission_, link->timer.expires_at());
  }
}

void GrantSender::send_one(std::span<ParticipantLink* const> links) {
  const ParticipantLink& any = *links.front();
  lockstep_grant_t grant{};
  for (const ParticipantLink* link : links) {
    grant.incarnations.push_back(link->incarnation);
    grant.first_turns.push_back(first_turn(*link));
  }
  grant.num_addressed = static_cast<std::int32_t>(links.size());
  grant.num_turns = any.turns_granted;
  grant.past = any.up_to_date ? 0 : 1;
  grant.slice_count = bus::slice_count(any.granted.size());
  std::string channel(bus::channels::kLockstepGrant);
  if (links.size() == 1) channel += "." + any.name;
  for (grant.slice_number = 0; grant.slice_number < grant.slice_count; ++grant.slice_number) {
    const auto slice = bus::slice_of(any.granted, grant.slice_number);
    grant.slice_bytes.assign(slice.begin(), slice.end());
    grant.num_slice_bytes = static_cast<std::int32_t>(slice.size());
    send_(channel, grant);
  }
}

void GrantSender::retransmit(ParticipantLinks& links, SimTime steady) {
  if (steady < next_retransmission_) return;
  next_retransmission_ = SimTime::never();
  std::vector<ParticipantLink*> unanswered;
  for (auto& [name, link] : links) {
    if (link.incarnation == 0) continue;
    if (link.timer.expires_at() <= steady) {
      unanswered.push_back(&link);
    } else {
      next_retransmission_ = std::min(next_retransmission_, link.timer.expires_at());
    }
  }
  retransmissions_ += static_cast<std::int64_t>(unanswered.size());
  send(unanswered, steady);
}

}  // namespace halocline::conductor
