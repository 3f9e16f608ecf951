// SPDX-License-Identifier: BSD-3-Clause
// Encoder and decoder of lcm-gen's message types, with the checks that LCM itself omits.
//
// A decoded message is valid, or refused with the reason: its bytes fit the layout of the type
// (wire_layout.h), and its values lie within the limits of the type (message_checks.h).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bus/messages/message_checks.h"
#include "bus/messages/messages.h"
#include "bus/messages/wire_layout.h"

namespace halocline::bus {

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

// Decodes one complete message. Returns the problem of the bytes, or an empty string. decode_unchecked() does
// not check the values.
template <class Message>
[[nodiscard]] std::string decode_unchecked(std::span<const std::uint8_t> bytes, Message& message) {
  std::string problem = misfit(wire_layout<Message>(), bytes.data(), bytes.size());
  if (problem.empty() && message.decode(bytes.data(), 0, static_cast<int>(bytes.size())) < 0)
    problem = "another type";
  return problem;
}
template <class Message>
[[nodiscard]] std::string decode(std::span<const std::uint8_t> bytes, Message& message) {
  std::string problem = decode_unchecked(bytes, message);
  return problem.empty() ? problem_in(message) : problem;
}

// Returns nothing when the bytes are not one complete valid message of the type.
template <class Message>
[[nodiscard]] std::optional<Message> decoded(std::span<const std::uint8_t> bytes) {
  Message message;
  return decode(bytes, message).empty() ? std::optional(std::move(message)) : std::nullopt;
}

// Integers in LCM's byte order: big-endian.
inline void append_uint32(std::uint32_t value, Bytes& to) {
  for (int shift = 24; shift >= 0; shift -= 8) to.push_back(static_cast<std::uint8_t>(value >> shift));
}
inline std::uint32_t uint32_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  const auto part = [&](std::size_t i, int shift) { return std::uint32_t{bytes[at + i]} << shift; };
  return part(0, 24) | part(1, 16) | part(2, 8) | part(3, 0);
}
inline void append_int64(std::int64_t value, Bytes& to) {
  append_uint32(static_cast<std::uint32_t>(static_cast<std::uint64_t>(value) >> 32), to);
  append_uint32(static_cast<std::uint32_t>(value), to);
}
inline std::int64_t int64_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::int64_t>(std::uint64_t{uint32_at(bytes, at)} << 32 | uint32_at(bytes, at + 4));
}

// Concatenates messages, each preceded by its length.
template <class Message>
Bytes encoded_list(std::span<const Message> messages) {
  Bytes bytes;
  for (const Message& message : messages) {
    append_uint32(static_cast<std::uint32_t>(message.getEncodedSize()), bytes);
    append_encoded(message, bytes);
  }
  return bytes;
}
// Returns nothing when the bytes are not a list of valid messages of the type.
template <class Message>
std::optional<std::vector<Message>> decoded_list(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kLengthBytes = 4;
  std::vector<Message> messages;
  while (!bytes.empty()) {
    if (bytes.size() < kLengthBytes || uint32_at(bytes, 0) > bytes.size() - kLengthBytes) return std::nullopt;
    const std::size_t length = uint32_at(bytes, 0);
    auto message = decoded<Message>(bytes.subspan(kLengthBytes, length));
    if (!message) return std::nullopt;
    messages.push_back(std::move(*message));
    bytes = bytes.subspan(kLengthBytes + length);
  }
  return messages;
}

}  // namespace halocline::bus
