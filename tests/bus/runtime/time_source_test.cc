// SPDX-License-Identifier: BSD-3-Clause
#include "bus/runtime/time_source.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/check.h"
#include "core/random.h"

namespace halocline::bus {
namespace {

SimTime at(double seconds) { return SimTime::from_seconds(seconds); }

class ConductorTimeTest : public ::testing::Test {
 protected:
  sim_clock_t clock_at(double sim_s, double rate = 1, std::int64_t session = 1) {
    sim_clock_t clock;
    clock.utime = at(sim_s).to_utime();
    clock.session = session;
    clock.sequence = sequence_++;
    clock.clock_rate = rate;
    clock.clock_step_us = 100'000;
    clock.lockstep = rate == 0;
    return clock;
  }
  void receive(double steady_s, double sim_s, double rate = 1, std::int64_t session = 1) {
    time_.on_clock(clock_at(sim_s, rate, session), at(steady_s));
  }
  // Two CLOCKs of a session, the second of these.
  void follow(double steady_s, double sim_s, double rate = 1, std::int64_t session = 1) {
    receive(steady_s - 0.1, sim_s - 0.1 * rate, rate, session);
    receive(steady_s, sim_s, rate, session);
  }
  double now(double steady_s) { return time_.now(at(steady_s))->seconds(); }

  lcm::LCM lcm_{"memq://"};
  ConductorTime time_{lcm_, "node"};
  std::int64_t sequence_ = 0;
};

TEST_F(ConductorTimeTest, KnowsNoTimeBeforeTheFirstClock) {
  EXPECT_FALSE(time_.now(at(5)).has_value());
  EXPECT_EQ(time_.steady_at(at(1)), SimTime::never());
}

TEST_F(ConductorTimeTest, ThreeSecondsWithoutAClockAreReportedOnce) {
  ::testing::internal::CaptureStderr();
  for (const double steady_s : {5.0, 7.9, 8.0, 8.1, 20.0}) EXPECT_FALSE(time_.now(at(steady_s)).has_value());
  const std::string lines = ::testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 1) << lines;
  EXPECT_NE(lines.find("no CLOCK for 3 s"), std::string::npos) << lines;
}

TEST_F(ConductorTimeTest, NothingIsReportedWhileClocksCome) {
  ::testing::internal::CaptureStderr();
  EXPECT_FALSE(time_.now(at(1)).has_value());
  follow(3.9, 1);
  for (const double steady_s : {4.0, 60.0}) EXPECT_TRUE(time_.now(at(steady_s)).has_value());
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST_F(ConductorTimeTest, FollowsTheClockAtItsRate) {
  follow(10, 100, 4);
  EXPECT_NEAR(now(10.5), 102, 1e-9);
  EXPECT_NEAR(time_.steady_at(at(104)).seconds(), 11, 1e-6);
}

TEST_F(ConductorTimeTest, ReceivesTheClockOnTheBus) {
  receive(1.9, 6.9);
  const sim_clock_t clock = clock_at(7);
  time_.set_steady(at(2));
  lcm_.publish("CLOCK", &clock);
  while (lcm_.handleTimeout(0) > 0) {
  }
  EXPECT_NEAR(now(2), 7, 1e-9);
}

TEST_F(ConductorTimeTest, AClockThatWaitedToBeHandledCountsFromWhenItWasReceived) {
  const auto wall_now = [] {
    const auto since_epoch = std::chrono::system_clock::now().time_since_epoch();
    return SimTime::from_nanoseconds(
        std::chrono::duration_cast<std::chrono::nanoseconds>(since_epoch).count());
  };
  receive(1.9, 6.7, 2);
  const sim_clock_t clock = clock_at(7, 2);
  const SimTime before = wall_now();
  lcm_.publish("CLOCK", &clock);
  const SimTime after = wall_now();
  const SimDuration waited = SimDuration::from_milliseconds(40);
  time_.set_steady(at(2), after + waited);
  while (lcm_.handleTimeout(0) > 0) {
  }
  constexpr double kStampStepS = 1e-6;
  EXPECT_GE(now(2), 7 + 2 * (waited.seconds() - kStampStepS));
  EXPECT_LE(now(2), 7 + 2 * ((after + waited - before).seconds() + kStampStepS));
}

TEST_F(ConductorTimeTest, CoastsWhenTheConductorIsSilent) {
  follow(1, 1);
  EXPECT_NEAR(now(60), 60, 1e-9);
  EXPECT_NEAR(now(3600), 3600, 1e-6);
}

// Delays of 0 to 30 ms: the smallest of the last second is the estimate, so with ten clocks the error is that
// of the luckiest, here below 10 ms throughout; and time never goes back.
TEST_F(ConductorTimeTest, FiltersJitterAndNeverGoesBack) {
  std::mt19937 random(3);
  double latest = 0;
  receive(0, 0);
  for (int tick = 1; tick < 500; ++tick) {
    const double sim = 0.1 * tick;
    const double delay = tick == 1 ? 0.0 : 3e-5 * static_cast<double>(random() % 1000);
    receive(sim + delay, sim);
    const double known = now(sim + delay);
    EXPECT_GE(known, latest);
    EXPECT_LE(known, sim + delay + 1e-9);
    if (tick > 10) {
      EXPECT_NEAR(known, sim + delay, 0.020);
    }
    latest = known;
  }
}

TEST_F(ConductorTimeTest, ANewRateIsTrackedAfterThreeSecondsWithoutTheOldOne) {
  follow(1, 1, 1);
  for (int tick = 1; tick <= 29; ++tick) receive(1 + 0.1 * tick, 1 + tick, 10);
  EXPECT_NEAR(now(3.95), 3.95, 1e-9);
  follow(4.2, 33, 10);
  EXPECT_NEAR(now(5.2), 43, 1e-9);
}

// One datagram, its time as expected.
TEST_F(ConductorTimeTest, AnotherRateIsRefusedWhileTheRightOneIsHeard) {
  follow(1, 100);
  double steady_s = 1;
  for (const double rate : {1e4, 1e6, 0.0}) {
    receive(steady_s + 0.05, steady_s + 99.05, rate);
    steady_s += 0.1;
    receive(steady_s, steady_s + 99);
    EXPECT_NEAR(now(steady_s), steady_s + 99, 1e-6) << rate;
  }
  EXPECT_EQ(time_.num_refused(), 3);
}

TEST_F(ConductorTimeTest, StandsStillWhilePaused) {
  follow(1, 1, 1);
  follow(5, 10, 0);
  EXPECT_NEAR(now(5), 10, 1e-9);
  EXPECT_NEAR(now(6), 10, 1e-9);
  EXPECT_EQ(time_.steady_at(at(11)), SimTime::never());
  follow(9, 10.1, 1);
  EXPECT_NEAR(now(10), 11.1, 1e-9);
}

TEST_F(ConductorTimeTest, ARestartedConductorThatContinuesTheTimeIsNoNewRun) {
  follow(1, 100, 1, 1);
  follow(5, 103.9, 1, 2);
  EXPECT_FALSE(time_.restarted());
  EXPECT_GE(now(5), 103.9);
  EXPECT_EQ(time_.num_refused(), 0);
}

TEST_F(ConductorTimeTest, AJumpBackIsANewRunReportedOnce) {
  follow(1, 100, 1, 1);
  EXPECT_NEAR(now(2), 101, 1e-9);
  follow(4.2, 0, 1, 2);
  EXPECT_TRUE(time_.restarted());
  EXPECT_FALSE(time_.restarted());
  EXPECT_NEAR(now(5.2), 1, 1e-9);
}

constexpr double kYear_s = 365.25 * 86'400;

TEST_F(ConductorTimeTest, AStrayClockTenYearsAheadIsRefusedAndReported) {
  follow(1, 100);
  ::testing::internal::CaptureStderr();
  receive(1.05, 10 * kYear_s, 1, 666);
  receive(1.1, 100.1);
  EXPECT_NEAR(now(1.2), 100.2, 1e-6);
  EXPECT_FALSE(time_.restarted());
  EXPECT_EQ(time_.num_refused(), 1);
  EXPECT_NE(
      ::testing::internal::GetCapturedStderr().find("channel=CLOCK count=1 reason=\"session is of a second"),
      std::string::npos);
}

// Forged ones that agree with each other, as many as come between two true ones.
TEST_F(ConductorTimeTest, LeapsOfTheSameSessionAreRefusedWhileItIsHeardAsExpected) {
  follow(1, 100);
  int forged = 0;
  for (int tick = 1; tick <= 600; ++tick) {
    for (const double leap_s : {6.0, 59.0, 3600.0, 10 * kYear_s, -99.0}) {
      for (const double later_s : {0.02, 0.03, 0.04}) {
        receive(0.9 + 0.1 * tick + later_s, 100 + 0.1 * tick + leap_s + later_s);
        ++forged;
      }
    }
    ASSERT_NEAR(now(0.95 + 0.1 * tick), 99.95 + 0.1 * tick, 1e-6);
    receive(1 + 0.1 * tick, 100 + 0.1 * tick);
    ASSERT_EQ(time_.num_refused(), forged);
  }
  EXPECT_FALSE(time_.restarted());
}

TEST_F(ConductorTimeTest, AnOldClockOfItsSessionSentAgainChangesNothing) {
  follow(1, 100);
  const sim_clock_t old = clock_at(100.1);
  for (int tick = 1; tick <= 400; ++tick) {
    const double passed_s = 0.1 * tick;
    if (tick > 90 && tick % 20 == 0) time_.on_clock(old, at(0.95 + passed_s));
    receive(1 + passed_s, 100 + passed_s);
    ASSERT_NEAR(now(1.05 + passed_s), 100.05 + passed_s, 1e-6);
  }
  EXPECT_EQ(time_.num_refused(), 0);
  EXPECT_FALSE(time_.restarted());
}

// As lcm-logplayer sends them: each 9 s old, at their pace; then the conductor is gone.
TEST_F(ConductorTimeTest, AllClocksOfTheRunSentAgainAfterNineSecondsChangeNothing) {
  follow(1, 100);
  std::vector<sim_clock_t> sent;
  for (int tick = 1; tick <= 600; ++tick) {
    const double passed_s = 0.1 * tick;
    sent.push_back(clock_at(100 + passed_s));
    if (tick > 90) time_.on_clock(sent[static_cast<std::size_t>(tick - 91)], at(0.98 + passed_s));
    if (tick < 300) time_.on_clock(sent.back(), at(1 + passed_s));
    ASSERT_NEAR(now(1.05 + passed_s), 100.05 + passed_s, 1e-6);
    if (tick == 389) break;  // all that the conductor published
  }
  EXPECT_EQ(time_.num_refused(), 0);
  EXPECT_FALSE(time_.restarted());
}

TEST_F(ConductorTimeTest, ALeapIsFollowedAfterThreeSecondsWithoutTheExpectedTime) {
  follow(1, 100);
  for (int tick = 1; tick <= 29; ++tick) receive(1 + 0.1 * tick, 4000 + 0.1 * tick);
  EXPECT_NEAR(now(3.95), 102.95, 1e-6);
  receive(4.0, 4003);
  receive(4.1, 4003.1);
  EXPECT_NEAR(now(4.2), 4003.2, 1e-6);
  EXPECT_FALSE(time_.restarted());
}

// A second conductor at ten times the rate, for a minute: nothing of it shows.
TEST_F(ConductorTimeTest, OfTwoConductorsTheFirstIsTracked) {
  follow(1, 1);
  for (int tick = 1; tick <= 600; ++tick) {
    const double passed_s = 0.1 * tick;
    receive(1 + passed_s, 1 + passed_s);
    receive(1.03 + passed_s, 10 * passed_s, 10, 2);
    ASSERT_NEAR(now(1.05 + passed_s), 1.05 + passed_s, 1e-6);
  }
  EXPECT_EQ(time_.num_refused(), 599);  // the last has not been outlived yet
}

TEST_F(ConductorTimeTest, AnotherConductorIsTrackedOnceTheFirstIsSilentForThreeSeconds) {
  follow(1, 100);
  for (int tick = 1; tick <= 29; ++tick) receive(1 + 0.1 * tick, 500 + 0.1 * tick, 1, 2);
  EXPECT_NEAR(now(3.95), 102.95, 1e-6);
  receive(4.0, 503.0, 1, 2);
  receive(4.1, 503.1, 1, 2);
  EXPECT_NEAR(now(4.2), 503.2, 1e-6);
}

TEST_F(ConductorTimeTest, OneClockIsNoTime) {
  receive(1, 10 * kYear_s, 1, 666);
  receive(1.5, 10 * kYear_s, 1, 666);  // the same again
  EXPECT_FALSE(time_.now(at(2)).has_value());
  follow(2, 5);
  EXPECT_NEAR(now(2), 5, 1e-9);
}

// Forged ones of ever new sessions push no witness out before the next CLOCK of the true one comes.
TEST_F(ConductorTimeTest, AFloodOfSessionsDoesNotKeepTheConductorFromBeingTracked) {
  for (int i = 0; i < 1000; ++i) {
    receive(1 + 0.01 * i, 1 + 0.01 * i);
    for (int k = 0; k < 3; ++k) receive(1 + 0.01 * i, 1e8 + i, 1, 1000 + 3 * i + k);
    if (i > 0) {
      ASSERT_NEAR(now(1 + 0.01 * i), 1 + 0.01 * i, 1e-6);
    }
  }
}

TEST_F(ConductorTimeTest, OneClockLongDelayedDoesNotSetTimeBack) {
  follow(1, 1);
  receive(2, 2);
  EXPECT_NEAR(now(2.5), 2.5, 1e-9);
  receive(2.6, 1.5);
  EXPECT_NEAR(now(2.7), 2.7, 1e-9);
}

TEST_F(ConductorTimeTest, FarInstantsDoNotOverflow) {
  follow(1, 1, 1e-3);
  EXPECT_EQ(time_.steady_at(SimTime::never()), SimTime::never());
  EXPECT_EQ(time_.steady_at(SimTime::at_once()), SimTime::at_once());
  EXPECT_GT(time_.steady_at(at(9e9)), at(1));
}

struct Drift {
  double rate;
  double skew;  // of the follower's clock against the conductor's, share
};
class ConductorTimeDay : public ConductorTimeTest, public ::testing::WithParamInterface<Drift> {};

// A simulated day of CLOCKs every 0.1 s of simulation time, received up to 5 ms late, one in a hundred 80 ms
// late, every tenth lost. Time lags by the least delay of the last second and may lead by what the clocks
// part in that second: it stays between -6 ms and +2 x skew x 1 s of the conductor's in its first hour as in
// its last, whatever went before.
TEST_P(ConductorTimeDay, StaysWithinItsBoundOfTheConductorForADay) {
  constexpr double kDay_s = 86'400, kWindow_s = 1.1, kDelay_s = 6e-3, kRounding_s = 2e-6;
  const auto [rate, skew] = GetParam();
  double worst_late = 0, worst_early = 0, last = -1, true_s = 0;
  std::uint64_t draw = 0;
  const auto uniform = [&] {
    return uniform_at({.seed = 1, .purpose = purpose_of("drift-test"), .who = 0, .which = draw++});
  };
  const double step_s = std::max(0.1, kDay_s / 400'000);
  for (double sim = 0; sim < kDay_s; sim += step_s) {
    const double conductor_s = sim / rate;
    if (uniform() < 0.1) continue;
    const double delay_s = uniform() < 0.01 ? 0.08 : 5e-3 * uniform();
    true_s = std::max(true_s, conductor_s + delay_s);  // none is reordered
    const double received_s = true_s * (1 + skew);
    receive(received_s, sim, rate);
    if (!time_.now(at(received_s))) continue;  // one CLOCK is no time
    const double error = now(received_s) - true_s * rate;
    if (conductor_s > kWindow_s)
      worst_late = std::min(worst_late, error), worst_early = std::max(worst_early, error);
    ASSERT_GE(now(received_s), last);
    last = now(received_s);
  }
  EXPECT_GT(worst_late, -(0.08 + kDelay_s) * rate);
  EXPECT_LT(worst_early, (2 * std::abs(skew) * kWindow_s + kRounding_s) * rate);
}
INSTANTIATE_TEST_SUITE_P(RatesAndSkews, ConductorTimeDay,
                         ::testing::Values(Drift{1, 0}, Drift{1, 1e-4}, Drift{1, -1e-4}, Drift{10, 5e-5},
                                           Drift{0.5, 0}));

}  // namespace
}  // namespace halocline::bus
