// SPDX-License-Identifier: BSD-3-Clause
// Lockstep messages on the wire: fragmentation into datagrams, reassembly, and digests of published messages.
//
// A body (the turns of a grant, the result of an answer) may be longer than a datagram and is then sent in
// slices. The same body is always divided in the same way, so slices of retransmissions can be combined.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bus/messages/message_codec.h"

namespace halocline::bus {

// Leaves room for the headers of the slice and of LCM below the 65 507 bytes of a UDP datagram.
inline constexpr std::size_t kMaxSliceBytes = 56'000;

// Returns the number of slices of a body, at least one, and the bytes of one slice.
int slice_count(std::size_t body_bytes);
std::span<const std::uint8_t> slice_of(const Bytes& body, int number);

// Reassembles the slices of one body; they may arrive in any order and repeatedly.
class SliceCollector {
 public:
  // `key` identifies the body: a slice with another key discards the previous ones. Returns the body when it
  // is complete.
  [[nodiscard]] std::optional<Bytes> add(std::int64_t key, int number, int count, const Bytes& slice);

 private:
  std::int64_t key_ = -1;
  std::vector<std::optional<Bytes>> slices_;
};

// Returns the digest of all messages published so far (XXH3 over instants, channels and bytes), continued
// from `before`. It shows whether an incarnation that replays the history publishes the same messages.
std::int64_t digest_of(std::int64_t before, std::span<const lockstep_message_t> published);

}  // namespace halocline::bus
