// SPDX-License-Identifier: BSD-3-Clause
#include "bus/repair/flow_history.h"

#include <algorithm>
#include <iterator>
#include <tuple>

namespace halocline::bus {

FlowHistory::Kept& FlowHistory::latest(std::string_view channel, std::int64_t session,
                                       std::int64_t sequence) {
  const auto found = by_name_.find(FlowName(channel, session));
  if (found != by_name_.end()) {
    flows_.splice(flows_.end(), flows_, found->second);
  } else {
    flows_.push_back({{std::string(channel), session, sequence}, 0, 0, {}});
    by_name_.emplace(FlowName(flows_.back().flow.channel, session), std::prev(flows_.end()));
    if (flows_.size() > kMaxFlows) forget_oldest_flow();
  }
  return flows_.back();
}

void FlowHistory::keep(std::string_view channel, std::int64_t session, std::int64_t sequence, Bytes message) {
  Kept& kept = latest(channel, session, sequence);
  kept.flow.last = std::max(kept.flow.last, sequence);
  kept.published = ++published_;
  kept.listed = 0;
  if (!kept.places.emplace(sequence, first_place_ + messages_.size()).second) return;
  bytes_ += message.size();
  messages_.push_back({.flow = std::prev(flows_.end()), .sequence = sequence, .bytes = std::move(message)});
  while (bytes_ > max_bytes_ && messages_.size() > 1) forget_oldest_message();
}

void FlowHistory::forget_oldest_message() {
  const Message& oldest = messages_.front();
  bytes_ -= oldest.bytes.size();
  if (oldest.flow != flows_.end()) oldest.flow->places.erase(oldest.sequence);
  messages_.pop_front();
  ++first_place_;
}

// Moves the oldest message to the end of the buffer, as if it had just been published.
void FlowHistory::renew_oldest_message() {
  Message oldest = std::move(messages_.front());
  messages_.pop_front();
  ++first_place_;
  oldest.flow->places[oldest.sequence] = first_place_ + messages_.size();
  messages_.push_back(std::move(oldest));
}

void FlowHistory::forget_old(SimTime steady) {
  constexpr SimDuration kBetweenMarks = SimDuration::from_milliseconds(1000);
  if (!marks_.empty() && steady < marks_.back().steady + kBetweenMarks) return;
  marks_.push_back({steady, first_place_ + messages_.size()});
  for (; marks_.front().steady + kMaxAge <= steady; marks_.pop_front()) {
    while (first_place_ < marks_.front().place) {
      const Message& oldest = messages_.front();
      if (oldest.flow != flows_.end() && oldest.sequence == oldest.flow->flow.last)
        renew_oldest_message();
      else
        forget_oldest_message();
    }
  }
}

void FlowHistory::forget_oldest_flow() {
  const Kept& oldest = flows_.front();
  for (const auto& [sequence, place] : oldest.places) {
    Message& message = messages_[place - first_place_];
    bytes_ -= message.bytes.size();
    message = {.flow = flows_.end(), .sequence = 0, .bytes = {}};
  }
  by_name_.erase(FlowName(oldest.flow.channel, oldest.flow.session));
  flows_.pop_front();
}

const Bytes* FlowHistory::find(std::string_view channel, std::int64_t session, std::int64_t sequence) const {
  const auto flow = by_name_.find(FlowName(channel, session));
  const Message* message = flow == by_name_.end() ? nullptr : find(*flow->second, sequence);
  return message == nullptr ? nullptr : &message->bytes;
}

const FlowHistory::Message* FlowHistory::find(const Kept& kept, std::int64_t sequence) const {
  const auto place = kept.places.find(sequence);
  return place == kept.places.end() ? nullptr : &messages_[place->second - first_place_];
}

FlowHistory::Message* FlowHistory::find_message(std::string_view channel, std::int64_t session,
                                                std::int64_t sequence) {
  const auto flow = by_name_.find(FlowName(channel, session));
  if (flow == by_name_.end()) return nullptr;
  const auto place = flow->second->places.find(sequence);
  return place == flow->second->places.end() ? nullptr : &messages_[place->second - first_place_];
}

bool FlowHistory::want(std::string_view channel, std::int64_t session, std::int64_t sequence,
                       SimTime steady) {
  Message* message = find_message(channel, session, sequence);
  if (message == nullptr || message->is_wanted || steady < message->answered + kAnswerInterval) return false;
  message->is_wanted = true;
  return true;
}

const Bytes* FlowHistory::answer(std::string_view channel, std::int64_t session, std::int64_t sequence,
                                 SimTime steady) {
  Message* message = find_message(channel, session, sequence);
  if (message == nullptr) return nullptr;
  message->is_wanted = false;
  message->answered = steady;
  return &message->bytes;
}

std::vector<FlowHistory::Flow> FlowHistory::take_listing() {
  const bool lists_all = flows_.size() <= kMaxListed;
  std::vector<Kept*> listed;
  for (Kept& kept : flows_) {
    if (lists_all || kept.published <= published_when_listed_) listed.push_back(&kept);
  }
  published_when_listed_ = published_;
  if (!lists_all && listed.size() > kMaxListed) {
    const auto rank = [](const Kept* kept) { return std::tuple(kept->listed, kept->published); };
    std::nth_element(listed.begin(), listed.begin() + kMaxListed, listed.end(),
                     [&](const Kept* a, const Kept* b) { return rank(a) < rank(b); });
    listed.resize(kMaxListed);
  }
  std::vector<Flow> flows;
  for (Kept* kept : listed) {
    ++kept->listed;
    flows.push_back(kept->flow);
  }
  return flows;
}

std::vector<FlowHistory::LastMessage> FlowHistory::last_messages(std::uint64_t published) const {
  std::vector<LastMessage> all;
  for (auto kept = flows_.rbegin(); kept != flows_.rend() && kept->published > published; ++kept) {
    const Message* message = find(*kept, kept->flow.last);
    if (message != nullptr) all.push_back({&kept->flow, &message->bytes});
  }
  std::reverse(all.begin(), all.end());
  return all;
}

}  // namespace halocline::bus
