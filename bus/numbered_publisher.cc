// SPDX-License-Identifier: BSD-3-Clause
#include "bus/numbered_publisher.h"

#include <algorithm>
#include <vector>

namespace halocline::bus {

NumberedPublisher::Number NumberedPublisher::take_next(std::string_view channel) {
  Number& next = channel_of(channel).next;
  const Number taken = next;
  ++next.sequence;
  return taken;
}

void NumberedPublisher::resume(std::string_view channel, std::int64_t session, std::int64_t sequence) {
  channel_of(channel).next = {session, sequence + 1};
}

NumberedPublisher::Channel& NumberedPublisher::channel_of(std::string_view channel) {
  auto found = channels_.find(channel);
  if (found == channels_.end()) {
    if (channels_.size() >= kMaxChannels) forget_unused_half();
    found = channels_.emplace(channel, Channel{{bus_.identity().session, 0}, 0}).first;
  }
  found->second.used_at = ++uses_;
  return found->second;
}

// Dropping half of the channels at once keeps the cost per message constant, even for an endless series of
// names.
void NumberedPublisher::forget_unused_half() {
  std::vector<std::uint64_t> uses;
  for (const auto& [name, channel] : channels_) uses.push_back(channel.used_at);
  const auto middle = uses.begin() + static_cast<std::ptrdiff_t>(uses.size() / 2);
  std::nth_element(uses.begin(), middle, uses.end());
  std::erase_if(channels_, [&](const auto& entry) { return entry.second.used_at < *middle; });
}

}  // namespace halocline::bus
