// SPDX-License-Identifier: BSD-3-Clause
// Non-cryptographic hashes: collisions are unlikely by chance, but easy to construct.
//
// FNV-1a of 64 bits (Fowler, Noll, Vo; http://www.isthe.com/chongo/tech/comp/fnv) is used for data that comes
// in pieces, and XXH3 of 64 bits (Collet; https://xxhash.com) for the identity of stored results and for
// check sums.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>

namespace halocline {

// Offset basis: the hash of no bytes.
inline constexpr std::uint64_t kFnvStart = 0xcbf29ce484222325u;

// Returns the hash of the bytes already covered by `sum`, followed by `bytes`.
constexpr std::uint64_t fnv1a(std::span<const std::uint8_t> bytes, std::uint64_t sum = kFnvStart) {
  for (const std::uint8_t byte : bytes) sum = (sum ^ byte) * 0x100000001b3u;
  return sum;
}

constexpr std::uint64_t fnv1a(std::string_view text, std::uint64_t sum = kFnvStart) {
  for (const char c : text) sum = (sum ^ static_cast<std::uint8_t>(c)) * 0x100000001b3u;
  return sum;
}

// Returns the 64-bit XXH3, the same on every platform. With the hash of preceding data as the seed it covers
// them, too.
std::uint64_t xxh3(std::string_view text, std::uint64_t seed = 0);
std::uint64_t xxh3(std::span<const std::uint8_t> bytes, std::uint64_t seed = 0);

// Hash for unordered containers of strings that are searched by std::string_view.
struct TextHash {
  using is_transparent = void;
  std::size_t operator()(std::string_view text) const { return std::hash<std::string_view>()(text); }
};

}  // namespace halocline
