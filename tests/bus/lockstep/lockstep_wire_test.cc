// SPDX-License-Identifier: BSD-3-Clause
#include "bus/lockstep/lockstep_wire.h"

#include <numeric>

#include <gtest/gtest.h>

#include "tests/bus/messages_for_tests.h"

namespace halocline::bus {
namespace {

using testing::valid_message;

Bytes body_of(std::size_t size) {
  Bytes body(size);
  std::iota(body.begin(), body.end(), std::uint8_t{3});
  return body;
}

Bytes copy(std::span<const std::uint8_t> bytes) { return {bytes.begin(), bytes.end()}; }

TEST(LockstepWire, ListsOfMessagesSurviveTheRoundTrip) {
  std::vector<lockstep_turn_t> turns;
  for (unsigned seed = 0; seed < 5; ++seed) turns.push_back(valid_message<lockstep_turn_t>(seed));
  const auto back = decoded_list<lockstep_turn_t>(encoded_list<lockstep_turn_t>(turns));
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(encoded_list<lockstep_turn_t>(*back), encoded_list<lockstep_turn_t>(turns));
}

TEST(LockstepWire, AListThatIsCutOffIsRefused) {
  const Bytes body = encoded_list<lockstep_turn_t>(std::vector{valid_message<lockstep_turn_t>(3)});
  for (std::size_t size = 1; size < body.size(); ++size)
    EXPECT_FALSE(decoded_list<lockstep_turn_t>(std::span(body).first(size)).has_value()) << size;
}

TEST(LockstepWire, SlicesMakeTheBodyInWhateverOrderTheyCome) {
  for (const std::size_t size :
       {std::size_t{0}, kMaxSliceBytes, kMaxSliceBytes + 1, 3 * kMaxSliceBytes - 7}) {
    const Bytes body = body_of(size);
    const int count = slice_count(size);
    SliceCollector collector;
    for (int i = count - 1; i > 0; --i) {
      EXPECT_FALSE(collector.add(7, i, count, copy(slice_of(body, i))).has_value());
      EXPECT_FALSE(collector.add(7, i, count, copy(slice_of(body, i))).has_value()) << "a repetition";
    }
    EXPECT_EQ(collector.add(7, 0, count, copy(slice_of(body, 0))), body);
  }
}

TEST(LockstepWire, SlicesOfTwoBodiesDoNotMix) {
  const Bytes one = body_of(2 * kMaxSliceBytes), other = body_of(2 * kMaxSliceBytes);
  SliceCollector collector;
  EXPECT_FALSE(collector.add(1, 0, 2, copy(slice_of(one, 0))).has_value());
  EXPECT_FALSE(collector.add(2, 1, 2, copy(slice_of(other, 1))).has_value());
  EXPECT_EQ(collector.add(2, 0, 2, copy(slice_of(other, 0))), other);
}

TEST(LockstepWire, TheDigestShowsEveryDifferenceAndMayBeMadeInPieces) {
  const auto a = valid_message<lockstep_message_t>(1), b = valid_message<lockstep_message_t>(2);
  const std::vector both{a, b}, swapped{b, a}, first{a}, second{b};
  EXPECT_EQ(digest_of(0, both), digest_of(digest_of(0, first), second));
  EXPECT_NE(digest_of(0, both), digest_of(0, swapped));
  auto changed = a;
  changed.message_bytes[0] ^= 1;
  EXPECT_NE(digest_of(0, first), digest_of(0, std::vector{changed}));
  EXPECT_EQ(digest_of(5, {}), 5);
}

}  // namespace
}  // namespace halocline::bus
