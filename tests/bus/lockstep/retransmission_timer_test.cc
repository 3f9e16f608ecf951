// SPDX-License-Identifier: BSD-3-Clause
#include "bus/lockstep/retransmission_timer.h"

#include <vector>

#include <gtest/gtest.h>

namespace halocline::conductor {
namespace {

SimTime at_us(std::int64_t n) { return SimTime() + SimDuration::from_microseconds(n); }

// Many exchanges, each answered after `us`.
RetransmissionTimer after_answers_of(std::int64_t us) {
  RetransmissionTimer timer;
  for (int i = 0; i < 100; ++i) {
    timer.on_sent(at_us(1'000'000 * i));
    timer.on_answered(at_us(1'000'000 * i + us));
  }
  return timer;
}

TEST(RetransmissionTimer, NeverExpiresWhenNothingWasSent) {
  EXPECT_EQ(RetransmissionTimer().expires_at(), SimTime::never());
}

TEST(RetransmissionTimer, TheTimeoutIsALittleAboveTheRoundTripTime) {
  RetransmissionTimer timer = after_answers_of(8000);
  timer.on_sent(at_us(0));
  EXPECT_GE(timer.expires_at(), at_us(8000));
  EXPECT_LE(timer.expires_at(), at_us(9000));
}

TEST(RetransmissionTimer, TheTimeoutIsNeverBelowItsMinimum) {
  RetransmissionTimer timer = after_answers_of(50);
  timer.on_sent(at_us(0));
  EXPECT_EQ(timer.expires_at(), at_us(0) + RetransmissionTimer::kMin);
}

TEST(RetransmissionTimer, TheTimeoutDoublesFromTheThirdRetransmissionUpToABound) {
  RetransmissionTimer timer = after_answers_of(50);
  std::vector<SimDuration> waits;
  for (int i = 0; i < 20; ++i) {
    timer.on_sent(at_us(0));
    waits.push_back(timer.expires_at() - at_us(0));
  }
  EXPECT_EQ(waits[0], RetransmissionTimer::kMin);
  EXPECT_EQ(waits[2], RetransmissionTimer::kMin);
  EXPECT_EQ(waits[4], RetransmissionTimer::kMin * 4);
  EXPECT_EQ(waits.back(), RetransmissionTimer::kMax);
}

TEST(RetransmissionTimer, AnAnswerToARetransmissionIsNoSample) {
  RetransmissionTimer timer = after_answers_of(8000);
  timer.on_sent(at_us(0));
  timer.on_sent(at_us(10'000));
  timer.on_answered(at_us(90'000));
  timer.on_sent(at_us(100'000));
  EXPECT_LE(timer.expires_at(), at_us(109'000));
}

}  // namespace
}  // namespace halocline::conductor
