// SPDX-License-Identifier: BSD-3-Clause
#include "bus/runtime/lockstep_runner.h"

#include <algorithm>
#include <iterator>
#include <tuple>

namespace halocline::bus {

LockstepRunner::LockstepRunner(std::vector<Node*> nodes, ForEach for_each)
    : nodes_(std::move(nodes)), published_(nodes_.size()), for_each_(std::move(for_each)) {
  std::stable_sort(nodes_.begin(), nodes_.end(), [](const Node* a, const Node* b) {
    return std::forward_as_tuple(a->stage(), a->name()) < std::forward_as_tuple(b->stage(), b->name());
  });
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    nodes_[i]->set_outbox([this, i](std::string_view channel, const void* data, std::size_t size) {
      published_[i].add(now_, channel, {static_cast<const std::uint8_t*>(data), size});
    });
  }
}

LockstepRunner::~LockstepRunner() {
  for (Node* node : nodes_) node->set_outbox(nullptr);
}

void LockstepRunner::run_until(SimTime end) {
  for (SimTime next = schedule_.next_instant(schedule_entries()); next <= end;
       next = schedule_.next_instant(schedule_entries())) {
    if (before_instant_ && !before_instant_(next)) return;
    now_ = next;
    schedule_.begin(next);
    step_all_due();
  }
  now_ = std::max(now_, end);
}

std::vector<ScheduleEntry> LockstepRunner::schedule_entries() const {
  std::vector<ScheduleEntry> entries;
  for (const Node* node : nodes_) {
    entries.push_back({static_cast<int>(node->stage()), std::max(node->lockstep_due(), now_)});
  }
  return entries;
}

void LockstepRunner::step_all_due() {
  for (auto round = schedule_.round(schedule_entries()); !round.empty();
       round = schedule_.round(schedule_entries())) {
    for_each_(round.size(), [&](std::size_t i) { nodes_[round[i]]->step({now_, now_}); });
    deliver();
  }
}

void LockstepRunner::deliver() {
  const auto to_all = [&](SimTime at, std::string_view channel, std::span<const std::uint8_t> message) {
    for (Node* receiver : receivers_of(channel)) receiver->receive(channel, message);
    if (listener_) listener_(at, channel, message);
  };
  const auto waiting = [](const MessageBatch& batch) { return !batch.empty(); };
  // Starts over at the first node that has messages, because a handler may publish more.
  for (auto from = std::find_if(published_.begin(), published_.end(), waiting); from != published_.end();
       from = std::find_if(published_.begin(), published_.end(), waiting)) {
    std::swap(*from, delivered_);
    delivered_.for_each(to_all);
    delivered_.clear();
  }
}

const std::vector<Node*>& LockstepRunner::receivers_of(std::string_view channel) {
  const auto known = receivers_.find(channel);
  if (known != receivers_.end()) return known->second;
  std::vector<Node*>& receivers = receivers_[std::string(channel)];
  std::copy_if(nodes_.begin(), nodes_.end(), std::back_inserter(receivers),
               [&](const Node* node) { return !node->subscribed_to(channel).empty(); });
  return receivers;
}

void LockstepRunner::stop() {
  for (Node* node : nodes_) {
    node->stop({now_, now_});
    deliver();
  }
}

}  // namespace halocline::bus
