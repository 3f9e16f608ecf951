// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/guarded_reading.h"

#include <array>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <new>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "core/check.h"

namespace halocline {
namespace {

using ::testing::HasSubstr;

std::string refusal(const std::function<void()>& reading) {
  try {
    require_survivable({"a.nc", "b.nc"}, reading);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "read";
}

TEST(GuardedReading, AReadingThatDiesIsRefusedWithItsFiles) {
  for (const int signal : {SIGSEGV, SIGABRT, SIGKILL}) {
    EXPECT_THAT(refusal([&] { std::raise(signal); }),
                HasSubstr("a.nc or b.nc is damaged: the library that reads it crashes on it"));
  }
  EXPECT_THAT(refusal([] { _exit(1); }), HasSubstr("crashes on it"));  // as a sanitizer ends
}

TEST(GuardedReading, AReadingThatTakesMoreThanThereIsIsRefused) {
  EXPECT_THAT(refusal([] { throw std::bad_alloc(); }),
              HasSubstr("b.nc: reading it takes more memory than is available"));
  EXPECT_EQ(refusal([] {
              rlimit memory{};
              getrlimit(RLIMIT_AS, &memory);
              if (memory.rlim_cur == RLIM_INFINITY) std::abort();
            }),
            "read");
}

TEST(GuardedReading, AReadingWithoutEndIsRefused) {
  EXPECT_THAT(
      refusal([] {
        setrlimit(RLIMIT_CPU, std::array<rlimit, 1>{{{1, RLIM_INFINITY}}}.data());  // sooner than its own
        for (volatile int i = 0;; i = 1 - i) {
        }
      }),
      HasSubstr("does not come to an end"));
}

TEST(GuardedReading, WhatAReadingThrowsIsTheCallers) {
  EXPECT_EQ(refusal([] { throw std::runtime_error("no such variable"); }), "read");
  EXPECT_THROW(guarded_reading({"a.nc"}, []() -> int { throw std::length_error("long"); }),
               std::length_error);
}

TEST(GuardedReading, TheChildLeavesNothingAndPrintsNothing) {
  int reads = 0;
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  require_survivable({"a.nc"}, [&] {
    ++reads;
    std::cout << "child" << std::flush;
    std::cerr << "child";
  });
  EXPECT_EQ(reads, 0);
  EXPECT_EQ(::testing::internal::GetCapturedStdout() + ::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(guarded_reading({"a.nc"}, [&] { return ++reads; }), 1);
}

TEST(GuardedReading, AProcessThatIgnoresItsChildrenLearnsOfTheEndAllTheSame) {
  std::signal(SIGCHLD, SIG_IGN);
  EXPECT_THAT(refusal([] { std::raise(SIGSEGV); }), HasSubstr("crashes on it"));
  EXPECT_EQ(std::signal(SIGCHLD, SIG_DFL), SIG_IGN);
}

TEST(GuardedReading, Hdf5IsKnownByItsSignatureAlsoBehindAUsersBlock) {
  const std::string path = ::testing::TempDir() + "signature-" + std::to_string(getpid());
  const std::string signature("\x89HDF\r\n\x1a\n", 8);
  for (const std::size_t at : {0, 512, 1024, 4096}) {
    std::ofstream(path, std::ios::binary) << std::string(at, ' ') + signature;
    EXPECT_TRUE(is_hdf5(path)) << at;
  }
  for (const std::string& other : {std::string(), std::string("CDF\1"), std::string(100, ' ') + signature}) {
    std::ofstream(path, std::ios::binary) << other;
    EXPECT_FALSE(is_hdf5(path));
  }
  EXPECT_FALSE(is_hdf5("/nowhere/a.nc"));
}

}  // namespace
}  // namespace halocline
