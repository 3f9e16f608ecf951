// Lockstep's messages on the wire: their channels, bodies cut into slices that fit a datagram and put together
// again, and sums over what was said.
//
// A body (the turns of a grant, the result of an answer) may be longer than what LCM carries well in one
// datagram; it travels in slices. The same body is always cut the same way, so slices of repetitions fit together.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bus/message_codec.h"

namespace halocline::bus {

// Leaves room for the heads of the slice and of LCM below the 65 507 bytes of a UDP datagram.
inline constexpr std::size_t kMaxSliceBytes = 56'000;

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
