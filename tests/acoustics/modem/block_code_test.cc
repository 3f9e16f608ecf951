// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/modem/block_code.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <map>

#include <gtest/gtest.h>

#include "acoustics/modem/bit_error.h"

namespace halocline::acoustics {
namespace {

// How many words of each weight the rows of a generator matrix span.
std::map<int, double> weights_of(const std::vector<std::uint64_t>& rows) {
  std::map<int, double> words;
  for (std::uint64_t choice = 1; choice < (1ull << rows.size()); ++choice) {
    std::uint64_t word = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) word ^= (choice >> i & 1) ? rows[i] : 0;
    words[std::popcount(word)] += 1;
  }
  return words;
}

std::map<int, double> weights_of(const BlockCode& code) {
  std::map<int, double> words;
  for (const BlockCode::Weight& weight : code.weights) words[weight.ones] = weight.words;
  return words;
}

// x times y in the field of 64 elements, x^6 = x + 1.
unsigned product(unsigned x, unsigned y) {
  unsigned sum = 0;
  for (; y; y >>= 1, x = (x << 1) ^ (x & 32 ? 0b1000011 : 0)) sum ^= y & 1 ? x : 0;
  return sum;
}

unsigned trace(unsigned x) {
  unsigned sum = 0;
  for (int i = 0; i < 6; ++i, x = product(x, x)) sum ^= x;
  return sum & 1;
}

// The code is spanned by the words, over all x of the field of 64: 1, Tr(a x) for six independent a, and
// Tr8(b x^9) for three independent b of the subfield of 8, where x^9 lies (MacWilliams and Sloane, chapter
// 9).
TEST(BlockCode, Bch64WeightsAreThoseOfTheCodeWrittenOut) {
  std::vector<std::uint64_t> rows(10);
  for (unsigned x = 0; x < 64; ++x) {
    rows[0] |= 1ull << x;
    for (unsigned i = 0; i < 6; ++i) rows[1 + i] |= std::uint64_t{trace(product(1u << i, x))} << x;
    unsigned norm = x;  // x^9 = x x^8
    for (int i = 0; i < 3; ++i) norm = product(norm, norm);
    norm = product(norm, x);
    for (unsigned i = 0; i < 3; ++i) {
      unsigned scale = 1;  // 1, g^9 and g^18, g = 2 being primitive, span the subfield
      for (unsigned n = 0; n < 9 * i; ++n) scale = product(scale, 2);
      const unsigned y = product(scale, norm), y2 = product(y, y), y4 = product(y2, y2);
      rows[7 + i] |= std::uint64_t{(y ^ y2 ^ y4) & 1u} << x;
    }
  }
  EXPECT_EQ(weights_of(rows), weights_of(bch_64_10()));
}

// Words of 16 that are 0 at two places, from all products of two of four variables, themselves and 1.
TEST(BlockCode, Hamming14WeightsAreThoseOfTheShortenedCodeWrittenOut) {
  std::vector<std::uint64_t> rows;
  const auto add = [&](auto value_at) {
    std::uint64_t row = 0;
    for (unsigned x = 0; x < 16; ++x) row |= std::uint64_t{value_at(x)} << x;
    rows.push_back(row);
  };
  add([](unsigned) { return 1u; });
  for (unsigned i = 0; i < 4; ++i) {
    add([=](unsigned x) { return x >> i & 1; });
    for (unsigned j = 0; j < i; ++j) add([=](unsigned x) { return (x >> i) & (x >> j) & 1; });
  }
  ASSERT_EQ(rows.size(), 11u);
  std::map<int, double> shortened;
  for (std::uint64_t choice = 1; choice < (1u << 11); ++choice) {
    std::uint64_t word = 0;
    for (std::size_t i = 0; i < 11; ++i) word ^= (choice >> i & 1) ? rows[i] : 0;
    if ((word & 3) == 0) shortened[std::popcount(word)] += 1;
  }
  EXPECT_EQ(shortened, weights_of(hamming_14_9()));
}

// A code of one bit sent n times is BPSK with all its energy in one place, exactly.
TEST(BlockCode, RepetitionGainsNothing) {
  const BlockCode repetition{7, 1, {{7, 1}}};
  for (const double g : {0.5, 2.0, 8.0}) {
    EXPECT_DOUBLE_EQ(coded_bit_error_rate(repetition, {g}),
                     bit_error_rate(Modulation::kBpsk, Fading::kNone, {g}));
  }
}

// High up the nearest words alone count: the gain over BPSK tends to 10 log10(distance times rate).
TEST(BlockCode, GainTendsToDistanceTimesRate) {
  const double g = 60;
  const double gain = 4 * 9.0 / 14;
  const double nearest =
      77 * 4.0 / 14 * bit_error_rate(Modulation::kBpsk, Fading::kNone, PowerRatio{gain * g});
  EXPECT_NEAR(coded_bit_error_rate(hamming_14_9(), {g}) / nearest, 1, 1e-9);
}

}  // namespace
}  // namespace halocline::acoustics
