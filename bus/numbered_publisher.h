// SPDX-License-Identifier: BSD-3-Clause
// Publisher that numbers messages: with the node's session, and on each channel the sequence 0, 1, 2, ...
// from which a receiver detects missing messages (flow_watch.h).
//
//   NumberedPublisher publisher(bus());
//   publisher.publish(channels::kState.of("auv-1"), state);  // fills in state.session and state.sequence
//
// The Bus must outlive it. Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "bus/bus.h"
#include "core/archive.h"
#include "core/limits.h"

namespace halocline::bus {

class NumberedPublisher {
 public:
  // Number of channels whose numbers are kept, more than the vehicles of a scenario have. Beyond it, the half
  // unused for longest begins again at 0.
  static constexpr std::size_t kMaxChannels = 16 * kMaxVehicles;

  explicit NumberedPublisher(Bus& bus) : bus_(bus) {}

  template <class Message>
  void publish(std::string_view channel, Message message) {
    number(channel, message);
    bus_.publish(channel, message);
  }
  // Sets message.session and message.sequence without publishing.
  template <class Message>
  void number(std::string_view channel, Message& message) {
    const Number number = take_next(channel);
    message.session = number.session;
    message.sequence = number.sequence;
  }

  // Continues the numbering of an earlier incarnation of the node, which published this number last: the
  // channel keeps its session.
  void resume(std::string_view channel, std::int64_t session, std::int64_t sequence);
  void archive(Archive& a) { a(channels_, uses_); }

 private:
  struct Number {
    std::int64_t session = 0, sequence = 0;
  };
  struct Channel {
    Number next;
    std::uint64_t used_at = 0;  // value of uses_ at the last use
  };
  Number take_next(std::string_view channel);
  Channel& channel_of(std::string_view channel);
  void forget_unused_half();

  Bus& bus_;
  std::map<std::string, Channel, std::less<>> channels_;
  std::uint64_t uses_ = 0;
};

}  // namespace halocline::bus
