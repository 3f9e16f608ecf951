// Lockstep's messages as bytes: encoded, cut into slices that fit a datagram, put together again, summed up.
//
// A body (the turns of a grant, the result of an answer) may be longer than what LCM carries well in one
// datagram; it travels in slices. The same body is always cut the same way, so slices of repetitions fit together.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bus/message_checks.h"
#include "bus/messages.h"
#include "bus/wire_layout.h"

namespace halocline::bus {

namespace channels {
// From the conductor: to all addressed; to one, on its own channel, which the others' readers pass over.
inline constexpr std::string_view kLockstepGrant = "LOCKSTEP_GRANT";
inline constexpr std::string_view kLockstepNotice = "LOCKSTEP_NOTICE";
// From participants.
inline constexpr std::string_view kLockstepAnswer = "LOCKSTEP_ANSWER";
inline constexpr std::string_view kLockstepJoin = "LOCKSTEP_JOIN";
}  // namespace channels

// Leaves room for the heads of the slice and of LCM below the 65 507 bytes of a UDP datagram.
inline constexpr std::size_t kMostSliceBytes = 56'000;

using Bytes = std::vector<std::uint8_t>;

template <class Message>
void append_encoded(const Message& message, Bytes& to) {
  const auto start = to.size(), size = static_cast<std::size_t>(message.getEncodedSize());
  to.resize(start + size);
  message.encode(to.data() + start, 0, static_cast<int>(size));
}

template <class Message>
Bytes encoded(const Message& message) {
  Bytes bytes;
  append_encoded(message, bytes);
  return bytes;
}

// Empty when the bytes are no sound message of that type, whole.
template <class Message>
std::optional<Message> decoded(std::span<const std::uint8_t> bytes) {
  Message message;
  if (!misfit(wire_layout<Message>(), bytes.data(), bytes.size()).empty()) return std::nullopt;
  if (message.decode(bytes.data(), 0, static_cast<int>(bytes.size())) < 0) return std::nullopt;
  if (!problem_in(message).empty()) return std::nullopt;
  return message;
}

// Turns as a grant's body holds them: each after its length.
Bytes encoded_turns(std::span<const lockstep_turn_t> turns);
// Empty when the bytes are not `count` sound turns, whole.
std::optional<std::vector<lockstep_turn_t>> decoded_turns(std::span<const std::uint8_t> bytes, int count);

// How many slices a body takes, one at least, and the bytes of one.
int slice_count(std::size_t body_bytes);
std::span<const std::uint8_t> slice_of(const Bytes& body, int number);

// Puts the slices of one body together, in whatever order and however often they come.
class SliceCollector {
 public:
  // `key` names the body: slices of another key are forgotten. Returns the body when it is whole.
  std::optional<Bytes> add(std::int64_t key, int number, int count, const Bytes& slice);

 private:
  std::int64_t key_ = -1;
  std::vector<std::optional<Bytes>> slices_;
};

// A sum over what was said so far (FNV-1a over instants, channels and bytes), for telling whether a life that
// repeats its past says the same.
std::int64_t digest_of(std::int64_t before, std::span<const lockstep_message_t> said);

}  // namespace halocline::bus
