// SPDX-License-Identifier: BSD-3-Clause
#include "core/hash.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace halocline {

std::uint64_t xxh3(std::string_view text, std::uint64_t seed) {
  return XXH3_64bits_withSeed(text.data(), text.size(), seed);
}

std::uint64_t xxh3(std::span<const std::uint8_t> bytes, std::uint64_t seed) {
  return XXH3_64bits_withSeed(bytes.data(), bytes.size(), seed);
}

}  // namespace halocline
