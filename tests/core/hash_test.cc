// SPDX-License-Identifier: BSD-3-Clause
#include "core/hash.h"

#include <array>

#include <gtest/gtest.h>

namespace halocline {
namespace {

// Test vectors: the FNV reference code (isthe.com/chongo/src/fnv/test_fnv.c).
TEST(Hash, GivesThePublishedSums) {
  EXPECT_EQ(fnv1a(""), 0xcbf29ce484222325u);
  EXPECT_EQ(fnv1a("a"), 0xaf63dc4c8601ec8cu);
  EXPECT_EQ(fnv1a("foobar"), 0x85944171f73967e8u);
}

// The value of no bytes: xxHash's own sanity test (cli/xsum_sanity_check.c); of a text: its C library, 0.8.1.
TEST(Hash, Xxh3GivesThePublishedValues) {
  EXPECT_EQ(xxh3(""), 0x2d06800538d394c2u);
  EXPECT_EQ(xxh3("foobar"), 0xd78fda63144c5c84u);
}

TEST(Hash, MayBeMadeInPiecesAndOfBytes) {
  constexpr std::array<std::uint8_t, 3> kBar{'b', 'a', 'r'};
  EXPECT_EQ(fnv1a(kBar, fnv1a("foo")), fnv1a("foobar"));
}

}  // namespace
}  // namespace halocline
