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

TEST(Hash, MayBeMadeInPiecesAndOfBytes) {
  constexpr std::array<std::uint8_t, 3> kBar{'b', 'a', 'r'};
  EXPECT_EQ(fnv1a(kBar, fnv1a("foo")), fnv1a("foobar"));
}

}  // namespace
}  // namespace halocline
