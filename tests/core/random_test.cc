// SPDX-License-Identifier: BSD-3-Clause
#include "core/random.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace halocline {
namespace {

// Known answers of the Random123 distribution (kat_vectors, philox4x32 10 rounds).
TEST(Random, PhiloxGivesThePublishedAnswers) {
  using Block = std::array<std::uint32_t, 4>;
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}), (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox4x32({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
            (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Random, EveryPartOfTheAddressChangesTheDraw) {
  const DrawAddress base{.seed = 1, .purpose = 2, .who = 3, .which = 4};
  std::set<std::uint64_t> draws{bits_at(base)};
  for (const DrawAddress& other :
       {DrawAddress{2, 2, 3, 4}, DrawAddress{1ull << 32 | 1, 2, 3, 4}, DrawAddress{1, 3, 3, 4},
        DrawAddress{1, 2, 4, 4}, DrawAddress{1, 2, 3, 5}, DrawAddress{1, 2, 3, 1ull << 32 | 4}}) {
    EXPECT_TRUE(draws.insert(bits_at(other)).second);
  }
  EXPECT_EQ(bits_at(base), bits_at(base));
}

TEST(Random, AnIdentityDependsOnEveryPartAndTheirOrder) {
  std::set<std::uint64_t> identities;
  for (const auto& parts : {std::initializer_list<std::uint64_t>{1, 2, 3},
                            {1, 2, 4},
                            {1, 3, 2},
                            {2, 2, 3},
                            {1, 2},
                            {1, 2, 3, 0},
                            {0, 1, 2, 3}}) {
    EXPECT_TRUE(identities.insert(identity_of(parts)).second);
  }
  EXPECT_EQ(identity_of({1, 2, 3}), identity_of({1, 2, 3}));
}

TEST(Random, UniformHasTheMomentsOfItsDistribution) {
  constexpr int kDraws = 200'000;
  double sum = 0, sum_of_squares = 0;
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    const double u = uniform_at({.seed = 5, .which = i});
    ASSERT_GT(u, 0);
    ASSERT_LT(u, 1);
    sum += u;
    sum_of_squares += u * u;
  }
  // 4.4 standard errors: a false alarm once in 1e5 seeds; the seed is fixed.
  EXPECT_NEAR(sum / kDraws, 0.5, 4.4 * std::sqrt(1.0 / 12 / kDraws));
  EXPECT_NEAR(sum_of_squares / kDraws, 1.0 / 3, 4.4 * std::sqrt(4.0 / 45 / kDraws));
}

TEST(Random, NormalHasTheMomentsAndTailsOfItsDistribution) {
  constexpr int kDraws = 200'000;
  double sum = 0, sum_of_squares = 0;
  int beyond_two = 0;
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    const double x = normal_at({.seed = 6, .which = i});
    sum += x;
    sum_of_squares += x * x;
    beyond_two += std::abs(x) > 2;
  }
  const double p = std::erfc(2 / std::sqrt(2.0));
  EXPECT_NEAR(sum / kDraws, 0, 4.4 / std::sqrt(kDraws));
  EXPECT_NEAR(sum_of_squares / kDraws, 1, 4.4 * std::sqrt(2.0 / kDraws));
  EXPECT_NEAR(static_cast<double>(beyond_two) / kDraws, p, 4.4 * std::sqrt(p * (1 - p) / kDraws));
}

}  // namespace
}  // namespace halocline
