// SPDX-License-Identifier: BSD-3-Clause
#include "conductor/conductor_node.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/runtime/lockstep_runner.h"
#include "core/check.h"

namespace halocline::conductor {
namespace {

class ConductorNodeTest : public ::testing::Test {
 protected:
  ConductorNodeTest() {
    listener_.subscribe<sim_clock_t>(bus::channels::kClock,
                                     [this](const sim_clock_t& m) { clocks_.push_back(m); });
  }
  lcm::LCM lcm_{"memq://"};
  bus::Bus listener_{lcm_, {"listener", 1}};
  std::vector<sim_clock_t> clocks_;
};

TEST_F(ConductorNodeTest, PublishesTheClockOnItsGridInLockstep) {
  ConductorNode node(lcm_, {"conductor", 77}, SimDuration::from_milliseconds(250), 0);
  bus::LockstepRunner runner({&node});
  runner.set_listener([&](SimTime, std::string_view channel, std::span<const std::uint8_t> message) {
    listener_.deliver(channel, message);
  });
  runner.run_until(SimTime::from_seconds(1));
  ASSERT_EQ(clocks_.size(), 5u);
  for (std::int64_t i = 0; i < 5; ++i) {
    const sim_clock_t& clock = clocks_[static_cast<std::size_t>(i)];
    EXPECT_EQ(clock.utime, 250'000 * i);
    EXPECT_EQ(clock.sequence, i);
    EXPECT_EQ(clock.session, 77);
    EXPECT_EQ(clock.clock_rate, 0);
    EXPECT_EQ(clock.clock_step_us, 250'000);
    EXPECT_TRUE(clock.lockstep);
  }
}

TEST_F(ConductorNodeTest, APacedClockCarriesTheTimeOfItsStepNotOfItsGrid) {
  ConductorNode node(lcm_, {"conductor", 1}, SimDuration::from_milliseconds(100), 2);
  node.step({SimTime::from_utime(103'000), SimTime::from_utime(51'500)});
  node.step({SimTime::from_utime(150'000), SimTime::from_utime(75'000)});  // not due
  node.step({SimTime::from_utime(200'001), SimTime::from_utime(100'000)});
  while (lcm_.handleTimeout(0) > 0) {
  }
  ASSERT_EQ(clocks_.size(), 2u);
  EXPECT_EQ(clocks_[0].utime, 103'000);
  EXPECT_EQ(clocks_[1].utime, 200'001);
  EXPECT_EQ(clocks_[0].clock_rate, 2);
  EXPECT_FALSE(clocks_[0].lockstep);
}

TEST_F(ConductorNodeTest, InRealTimeItReportsTheClocksOfAnotherAndStays) {
  ConductorNode node(lcm_, {"conductor", 1}, SimDuration::from_milliseconds(100), 1);
  ConductorNode other(lcm_, {"conductor", 2}, SimDuration::from_milliseconds(100), 10);
  ::testing::internal::CaptureStderr();
  for (int step = 1; step <= 5; ++step) {
    const SimTime at = SimTime::from_utime(100'000 * step);
    node.step({at, at});
    other.step({at, at});
    while (lcm_.handleTimeout(0) > 0) {
    }
  }
  EXPECT_EQ(node.counters().duplicate_publishers, 5);
  EXPECT_EQ(other.counters().duplicate_publishers, 5);
  EXPECT_NE(::testing::internal::GetCapturedStderr().find("session is 2, of a second conductor"),
            std::string::npos);
  EXPECT_EQ(clocks_.size(), 10u);
}

TEST_F(ConductorNodeTest, APeriodAndARateArePossible) {
  EXPECT_THROW(ConductorNode(lcm_, {"c", 1}, SimDuration(), 1), InvalidArgument);
  EXPECT_THROW(ConductorNode(lcm_, {"c", 1}, SimDuration::from_seconds(1), -1), InvalidArgument);
}

}  // namespace
}  // namespace halocline::conductor
