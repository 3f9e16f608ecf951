#include "bus/flow_history.h"

#include <algorithm>

namespace halocline::bus {

void FlowHistory::keep(std::string_view channel, std::int64_t session, std::int64_t sequence, Bytes message) {
  const FlowName name(channel, session);
  const auto [flow, is_new] = flows_.try_emplace(name, Kept{sequence, 0, {}});
  flow->second.last = std::max(flow->second.last, sequence);
  flow->second.age = ++age_;
  const std::size_t size = message.size();
  if (!flow->second.messages.emplace(sequence, std::move(message)).second) return;
  bytes_ += size;
  in_order_.emplace_back(name, sequence);
  while (bytes_ > max_bytes_ && in_order_.size() > 1) forget_oldest_message();
  if (is_new && flows_.size() > kMaxFlows) forget_oldest_flow();
}

void FlowHistory::forget_oldest_message() {
  const auto [name, sequence] = std::move(in_order_.front());
  in_order_.pop_front();
  const auto flow = flows_.find(name);
  if (flow == flows_.end()) return;  // the whole flow was forgotten before
  const auto message = flow->second.messages.find(sequence);
  if (message == flow->second.messages.end()) return;
  bytes_ -= message->second.size();
  flow->second.messages.erase(message);
}

void FlowHistory::forget_oldest_flow() {
  const auto oldest = std::min_element(
      flows_.begin(), flows_.end(), [](const auto& a, const auto& b) { return a.second.age < b.second.age; });
  for (const auto& [sequence, message] : oldest->second.messages) bytes_ -= message.size();
  flows_.erase(oldest);
}

const Bytes* FlowHistory::find(std::string_view channel, std::int64_t session, std::int64_t sequence) const {
  const auto flow = flows_.find(FlowName(channel, session));
  if (flow == flows_.end()) return nullptr;
  const auto message = flow->second.messages.find(sequence);
  return message == flow->second.messages.end() ? nullptr : &message->second;
}

std::vector<FlowHistory::Flow> FlowHistory::flows() const {
  std::vector<Flow> all;
  all.reserve(flows_.size());
  for (const auto& [name, kept] : flows_) all.push_back({name.first, name.second, kept.last});
  return all;
}

std::vector<FlowHistory::LastMessage> FlowHistory::last_messages() const {
  std::vector<LastMessage> all;
  for (const auto& [name, kept] : flows_) {
    const auto last = kept.messages.find(kept.last);
    if (last != kept.messages.end()) all.push_back({{name.first, name.second, kept.last}, &last->second});
  }
  return all;
}

}  // namespace halocline::bus
