// SPDX-License-Identifier: BSD-3-Clause
#include "bus/transport/unsent_messages.h"

namespace halocline::bus {

void UnsentMessages::keep(SimTime steady, std::string_view channel, const void* data, std::size_t size) {
  if (messages_.empty()) next_due_ = steady + kRetry;
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  messages_.push_back({steady, std::string(channel), {bytes, bytes + size}});
  bytes_ += size;
  while (bytes_ > kMaxBytes && messages_.size() > 1) forget_first();
}

void UnsentMessages::send(SimTime steady, const Send& send) {
  if (messages_.empty()) return;
  next_due_ = steady + kRetry;
  while (!messages_.empty() &&
         send(messages_.front().channel, messages_.front().bytes.data(), messages_.front().bytes.size()))
    forget_first();
  while (!messages_.empty() && steady - messages_.front().since >= kKept) forget_first();
}

void UnsentMessages::forget_first() {
  bytes_ -= messages_.front().bytes.size();
  messages_.pop_front();
}

}  // namespace halocline::bus
