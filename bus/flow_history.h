// Retransmission buffer of one publisher: its latest messages by flow and sequence number, from which repair
// requests are answered. Bounded: the oldest messages of all flows make room.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bus/message_codec.h"

namespace halocline::bus {

class FlowHistory {
 public:
  static constexpr std::size_t kMaxFlows = 500;
  // `max_bytes` of messages are kept, and the last message whatever its size.
  explicit FlowHistory(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  // A message of the flow (channel, session) was published. One with a number that is kept already changes nothing.
  void keep(std::string_view channel, std::int64_t session, std::int64_t sequence, Bytes message);
  // The message, or null when it is not kept (any more).
  const Bytes* find(std::string_view channel, std::int64_t session, std::int64_t sequence) const;

  // The kMaxFlows flows published on most recently, each with the greatest number so far.
  struct Flow {
    std::string channel;
    std::int64_t session = 0, last = 0;
  };
  std::vector<Flow> flows() const;
  // The same, each with its last message; without those that are not kept any more.
  struct LastMessage {
    Flow flow;
    const Bytes* message = nullptr;
  };
  std::vector<LastMessage> last_messages() const;

 private:
  using FlowName = std::pair<std::string, std::int64_t>;  // channel, session
  struct Kept {
    std::int64_t last = 0;
    std::uint64_t age = 0;  // counts all messages: greater for the flow published on later
    std::map<std::int64_t, Bytes> messages;
  };
  using Flows = std::map<FlowName, Kept, std::less<>>;
  void forget_oldest_message();
  void forget_oldest_flow();

  std::size_t max_bytes_, bytes_ = 0;
  std::uint64_t age_ = 0;
  Flows flows_;
  std::deque<std::pair<FlowName, std::int64_t>> in_order_;
};

}  // namespace halocline::bus
