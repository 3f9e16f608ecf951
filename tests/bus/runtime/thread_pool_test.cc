// SPDX-License-Identifier: BSD-3-Clause
#include "bus/runtime/thread_pool.h"

#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "core/check.h"

namespace halocline::bus {
namespace {

TEST(ThreadPool, CallsTheBodyOnceForEachIndexInEachCall) {
  ThreadPool pool(4);
  for (int call = 0; call < 50; ++call) {
    std::vector<std::atomic<int>> calls(100);
    pool.for_each(calls.size(), [&](std::size_t i) { ++calls[i]; });
    for (const auto& count : calls) ASSERT_EQ(count, 1);
  }
}

TEST(ThreadPool, OfOneThreadRunsOnTheCaller) {
  ThreadPool pool(1);
  pool.for_each(3, [caller = std::this_thread::get_id()](std::size_t) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
  });
}

TEST(ThreadPool, ThrowsTheExceptionOfTheLowestIndexAfterTheRestIsDone) {
  ThreadPool pool(3);
  std::atomic<int> calls = 0;
  try {
    pool.for_each(20, [&](std::size_t i) {
      ++calls;
      if (i % 7 == 5) throw std::runtime_error(std::to_string(i));
    });
    FAIL() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "5");
  }
  EXPECT_EQ(calls, 20);
  pool.for_each(2, [&](std::size_t) { ++calls; });
  EXPECT_EQ(calls, 22);
}

TEST(ThreadPool, NeedsAThread) { EXPECT_THROW(ThreadPool(0), InvalidArgument); }

}  // namespace
}  // namespace halocline::bus
