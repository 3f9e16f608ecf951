// SPDX-License-Identifier: BSD-3-Clause
#include "bus/lockstep/lockstep_wire.h"

#include <algorithm>
#include <array>
#include <bit>

#include "core/hash.h"

namespace halocline::bus {
int slice_count(std::size_t body_bytes) {
  return static_cast<int>(std::max<std::size_t>(1, (body_bytes + kMaxSliceBytes - 1) / kMaxSliceBytes));
}

std::span<const std::uint8_t> slice_of(const Bytes& body, int number) {
  const std::size_t start = static_cast<std::size_t>(number) * kMaxSliceBytes;
  return std::span(body).subspan(start, std::min(kMaxSliceBytes, body.size() - start));
}

std::optional<Bytes> SliceCollector::add(std::int64_t key, int number, int count, const Bytes& slice) {
  if (key != key_ || slices_.size() != static_cast<std::size_t>(count)) {
    key_ = key;
    slices_.assign(static_cast<std::size_t>(count), std::nullopt);
  }
  slices_[static_cast<std::size_t>(number)] = slice;
  Bytes body;
  for (const auto& part : slices_) {
    if (!part) return std::nullopt;
    body.insert(body.end(), part->begin(), part->end());
  }
  key_ = -1;
  slices_.clear();
  return body;
}

std::int64_t digest_of(std::int64_t before, std::span<const lockstep_message_t> published) {
  auto sum = static_cast<std::uint64_t>(before);
  for (const lockstep_message_t& message : published) {
    const auto instant =
        std::bit_cast<std::array<std::uint8_t, sizeof message.instant_ns>>(message.instant_ns);
    sum = xxh3(message.message_bytes, xxh3(message.channel_name, xxh3(instant, sum)));
  }
  return static_cast<std::int64_t>(sum);
}

}  // namespace halocline::bus
