// SPDX-License-Identifier: BSD-3-Clause
// Lockstep's messages on the wire: fragmentation into datagrams and reassembly, and digests of
// published messages.
//
// A body (the turns of a grant, the result of an answer) may be longer than a datagram; it travels in slices.
// The same body is always cut the same way, so slices of retransmissions fit together.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bus/message_codec.h"

namespace halocline::bus {

// Leaves room for the headers of the slice and of LCM below the 65 507 bytes of a UDP datagram.
inline constexpr std::size_t kMaxSliceBytes = 56'000;

// How many slices a body takes, one at least, and the bytes of one.
int slice_count(std::size_t body_bytes);
std::span<const std::uint8_t> slice_of(const Bytes& body, int number);

// Reassembles the slices of one body, in whatever order and however often they are received.
class SliceCollector {
 public:
  // `key` identifies the body: slices of another key are discarded. Returns the body when it is whole.
  [[nodiscard]] std::optional<Bytes> add(std::int64_t key, int number, int count, const Bytes& slice);

 private:
  std::int64_t key_ = -1;
  std::vector<std::optional<Bytes>> slices_;
};

// Digest of all messages published so far (XXH3 over instants, channels and bytes), continued from `before`:
// shows whether an incarnation that replays the history publishes the same.
std::int64_t digest_of(std::int64_t before, std::span<const lockstep_message_t> published);

}  // namespace halocline::bus
