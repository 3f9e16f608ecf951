// SPDX-License-Identifier: BSD-3-Clause
#include "core/memory/memory_budget.h"

#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "core/check.h"

namespace halocline {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(MemoryBudget, SizesAreShortForAPerson) {
  EXPECT_EQ(size_text(512), "512 B");
  EXPECT_EQ(size_text(3.44e11), "344 GB");
  EXPECT_EQ(size_text(1.26e6), "1.3 MB");
}

TEST(MemoryBudget, WhatNoMachineHasIsRefusedWithBothSizesAndARemedy) {
  require_memory(1000, "a small grid", "take none");
  try {
    require_memory(1e18, "the grid", "take a smaller one");
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("the grid needs about 1000 PB of memory, and "),
                                    HasSubstr(" are available; take a smaller one")));
  }
}

// As `ulimit -v` sets it, which a process cannot lift again where it is the hard one.
TEST(MemoryBudget, ALimitOfTheAddressSpaceCounts) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
  // Above what is mapped already: a sanitizer maps terabytes.
  constexpr rlim_t kRoom = rlim_t{1} << 34;
  std::ifstream status("/proc/self/statm");
  rlim_t mapped_pages = 0;
  status >> mapped_pages;
  const rlimit limit{mapped_pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + kRoom, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_AS, &limit), 0);
  const double available_bytes = available_memory_bytes();
  ASSERT_EQ(setrlimit(RLIMIT_AS, &before), 0);
  EXPECT_LT(available_bytes, 1.1 * static_cast<double>(kRoom));
}

}  // namespace
}  // namespace halocline
