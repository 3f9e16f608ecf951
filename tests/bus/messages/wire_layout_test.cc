// SPDX-License-Identifier: BSD-3-Clause
// The layout of each type consumes exactly the bytes that its encoder writes, and refuses bytes that its
// decoder cannot read.
#include "bus/messages/wire_layout.h"

#include <chrono>
#include <cstdint>
#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include "bus/messages/message_codec.h"
#include "tests/bus/messages_for_tests.h"

namespace halocline::bus {
namespace {

using testing::valid_message;

constexpr unsigned kSeeds = 12;

template <class Message>
std::string misfit_of(const std::vector<std::uint8_t>& bytes) {
  return misfit(wire_layout<Message>(), bytes.data(), bytes.size());
}

void put_int32(std::vector<std::uint8_t>& bytes, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
}

template <class Message>
class WireLayoutOf : public ::testing::Test {};
TYPED_TEST_SUITE(WireLayoutOf, testing::TypesOf<AllMessages>::Type);

TYPED_TEST(WireLayoutOf, ConsumesExactlyTheBytesOfAnEncodedMessage) {
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    EXPECT_EQ(misfit_of<TypeParam>(encoded(valid_message<TypeParam>(seed))), "") << "seed " << seed;
  }
}

TYPED_TEST(WireLayoutOf, RefusesEveryTruncation) {
  const auto bytes = encoded(valid_message<TypeParam>(5));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_NE(misfit(wire_layout<TypeParam>(), bytes.data(), size), "") << size << " of " << bytes.size();
  }
}

TYPED_TEST(WireLayoutOf, RefusesBytesBeyondTheEnd) {
  auto bytes = encoded(valid_message<TypeParam>(3));
  bytes.push_back(0);
  EXPECT_EQ(misfit_of<TypeParam>(bytes), "longer than its fields");
}

// The decoder reads what the layout accepts without an exception and to the last byte.
TYPED_TEST(WireLayoutOf, AcceptsOnlyBytesThatTheDecoderReads) {
  std::mt19937 random(1);
  int passed = 0;
  for (int round = 0; round < 3000; ++round) {
    auto bytes = encoded(valid_message<TypeParam>(static_cast<unsigned>(round) % kSeeds));
    for (int flips = 0; flips < 3; ++flips) {
      const std::size_t at = 8 + random() % (bytes.size() - 8);
      bytes[at] = static_cast<std::uint8_t>(random() % 4 == 0 ? 0xff : random());
    }
    if (!misfit_of<TypeParam>(bytes).empty()) continue;
    ++passed;
    TypeParam message;
    ASSERT_NO_THROW(ASSERT_EQ(message.decode(bytes.data(), 0, static_cast<int>(bytes.size())),
                              static_cast<int>(bytes.size())));
  }
  EXPECT_GT(passed, 0);
}

// Each offset in turn holds a huge and a negative number: a count or a length with it is refused before
// memory is allocated.
TYPED_TEST(WireLayoutOf, AnyHugeCountIsRefusedOrIsNoCount) {
  const auto good = encoded(valid_message<TypeParam>(4));
  for (const std::uint32_t value : {0x7fffffffu, 0x80000000u, 0xffffffffu, 0x00ffffffu}) {
    for (std::size_t at = 8; at + 4 <= good.size(); ++at) {
      auto bytes = good;
      put_int32(bytes, at, value);
      if (!misfit_of<TypeParam>(bytes).empty()) continue;
      TypeParam message;
      ASSERT_NO_THROW(message.decode(bytes.data(), 0, static_cast<int>(bytes.size()))) << "at " << at;
    }
  }
}

TEST(WireLayout, ACountOfTwoThousandMillionIsRefusedAtItsPlace) {
  auto bytes = encoded(valid_message<link_table_t>(0));  // ends in its count, which is 0
  put_int32(bytes, bytes.size() - 4, 2'000'000'000);
  EXPECT_EQ(misfit_of<link_table_t>(bytes), "array longer than the message");
  put_int32(bytes, bytes.size() - 4, 0xfffffff0u);
  EXPECT_EQ(misfit_of<link_table_t>(bytes), "impossible array length");
}

TEST(WireLayout, AStringOfLengthZeroOrWithoutItsEndIsRefused) {
  const node_status_t status = valid_message<node_status_t>(1);
  constexpr std::size_t kNameLength = 8 + 3 * 8;
  auto bytes = encoded(status);
  put_int32(bytes, kNameLength, 0);
  EXPECT_EQ(misfit_of<node_status_t>(bytes), "impossible string length");
  bytes = encoded(status);
  put_int32(bytes, kNameLength, 0x7fffffff);
  EXPECT_EQ(misfit_of<node_status_t>(bytes), "string longer than the message");
  bytes = encoded(status);
  bytes[kNameLength + 4 + status.node_name.size()] = 'x';
  EXPECT_EQ(misfit_of<node_status_t>(bytes), "string without its end");
}

// It would be encoded as a shorter one.
TEST(WireLayout, AStringWithAZeroInItIsRefused) {
  auto bytes = encoded(valid_message<node_status_t>(1));
  bytes[8 + 3 * 8 + 4] = 0;
  EXPECT_EQ(misfit_of<node_status_t>(bytes), "string with a zero in it");
}

TEST(WireLayout, NothingAtAllIsTooShort) {
  EXPECT_EQ(misfit(wire_layout<sim_clock_t>(), nullptr, 0), "too short");
  const std::uint8_t seven[7] = {};
  EXPECT_EQ(misfit(wire_layout<sim_clock_t>(), seven, sizeof seven), "too short");
}

}  // namespace
}  // namespace halocline::bus
