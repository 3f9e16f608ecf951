// SPDX-License-Identifier: BSD-3-Clause
#include "bus/transport/publication_pace.h"

#include <cstddef>

#include <gtest/gtest.h>

#include "core/sim_time.h"
#include "tests/support/tolerance.h"

namespace halocline::bus {
namespace {

using halocline::testing::tolerance;

// How long `count` messages of a size take that follow each other as fast as they may.
double seconds_for(PublicationPace& pace, int count, std::size_t bytes, SimTime begin = {}) {
  SimTime now = begin;
  for (int i = 0; i < count; ++i) now = now + pace.wait_before(bytes, now);
  return (now - begin).seconds();
}

TEST(PublicationPace, ABurstIsNotDelayed) {
  PublicationPace pace;
  EXPECT_EQ(seconds_for(pace, static_cast<int>(PublicationPace::kBurstMessages), 200), 0);
}

TEST(PublicationPace, ManySmallMessagesGoAtTheirRate) {
  PublicationPace pace;
  constexpr int kMessages = 4800;
  EXPECT_NEAR(seconds_for(pace, kMessages, 200), kMessages / PublicationPace::kMessagesPerS, tolerance(1e-3));
}

TEST(PublicationPace, LargeMessagesGoAtTheRateOfTheirBytes) {
  PublicationPace pace;
  constexpr int kMessages = 400;
  constexpr std::size_t kBytes = 60'000;
  EXPECT_NEAR(seconds_for(pace, kMessages, kBytes), kMessages * kBytes / PublicationPace::kBytesPerS,
              tolerance(0.02));
}

// The rate holds on average whatever the size, up to LCM's largest.
TEST(PublicationPace, AMessageLargerThanABurstIsMadeUpForByThoseAfterIt) {
  PublicationPace pace;
  constexpr std::size_t kBytes = 10 << 20;
  EXPECT_NEAR(seconds_for(pace, 11, kBytes), 10 * kBytes / PublicationPace::kBytesPerS, tolerance(0.01));
}

TEST(PublicationPace, APauseAllowsAnotherBurst) {
  PublicationPace pace;
  const double first_s = seconds_for(pace, 100, 200);
  EXPECT_GT(first_s, 0);
  EXPECT_EQ(seconds_for(pace, static_cast<int>(PublicationPace::kBurstMessages), 200,
                        SimTime::from_seconds(first_s + 0.001)),
            0);
}

}  // namespace
}  // namespace halocline::bus
