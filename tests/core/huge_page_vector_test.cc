// SPDX-License-Identifier: BSD-3-Clause
#include "core/huge_page_vector.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <new>
#include <numeric>

#include <gtest/gtest.h>

namespace halocline {
namespace {

constexpr std::size_t kLarge = 3 << 20;  // floats: 12 MB

// A page of 2 MB begins where its number is a multiple of that.
TEST(HugePageVector, BeginsWithAPageWhereItIsLarge) {
  HugePageVector<float> large(kLarge, 1.0F);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(large.data()) % (2 << 20), 0u);
  EXPECT_EQ(std::accumulate(large.begin(), large.end(), 0.0), static_cast<double>(kLarge));
}

TEST(HugePageVector, GrowsAcrossItsBoundAndKeepsWhatItHolds) {
  HugePageVector<std::uint32_t> growing;
  for (std::uint32_t i = 0; i < kLarge; ++i) growing.push_back(i);
  const HugePageVector<std::uint32_t> copy = growing;
  growing.resize(10);
  growing.shrink_to_fit();
  EXPECT_EQ(growing.back(), 9u);
  EXPECT_EQ(copy[kLarge - 1], kLarge - 1);
}

TEST(HugePageVector, MoreThanThereIsIsRefused) {
  HugePageAllocator<double> allocator;
  EXPECT_THROW(static_cast<void>(allocator.allocate(std::numeric_limits<std::size_t>::max() / 4)),
               std::bad_alloc);
}

}  // namespace
}  // namespace halocline
