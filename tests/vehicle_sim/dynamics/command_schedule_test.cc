// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/dynamics/command_schedule.h"

#include <cstdint>

#include <gtest/gtest.h>

#include "core/check.h"
#include "tests/support/at_ms.h"

namespace halocline::vehicle_sim {
namespace {

constexpr SimDuration kTimeout = SimDuration::from_milliseconds(2000);
constexpr ActuatorValues kPort{-0.1, 0, 10}, kStarboard{0.1, 0, 20};

using halocline::testing::at_ms;

TEST(CommandSchedule, WithoutACommandTheStateIsSafe) {
  CommandSchedule schedule(kTimeout);
  EXPECT_TRUE(schedule.is_safe_state());
  EXPECT_EQ(schedule.at(at_ms(0)), ActuatorValues());
  EXPECT_TRUE(schedule.is_safe_state());
}

TEST(CommandSchedule, ACommandHoldsFromItsOwnTimeOn) {
  CommandSchedule schedule(kTimeout);
  EXPECT_EQ(schedule.add({at_ms(500), kPort}, at_ms(0)), CommandVerdict::kTaken);
  EXPECT_EQ(schedule.at(at_ms(499)), ActuatorValues());
  EXPECT_EQ(schedule.at(at_ms(500)), kPort);
  EXPECT_FALSE(schedule.is_safe_state());
}

TEST(CommandSchedule, ACommandIsVoidOnceOlderThanTheTimeout) {
  CommandSchedule schedule(kTimeout);
  EXPECT_EQ(schedule.add({at_ms(0), kPort}, at_ms(0)), CommandVerdict::kTaken);
  EXPECT_EQ(schedule.at(at_ms(2000)), kPort);
  EXPECT_EQ(schedule.at(at_ms(2001)), ActuatorValues());
  EXPECT_TRUE(schedule.is_safe_state());
}

TEST(CommandSchedule, ANewCommandEndsTheSafeState) {
  CommandSchedule schedule(kTimeout);
  EXPECT_EQ(schedule.add({at_ms(0), kPort}, at_ms(0)), CommandVerdict::kTaken);
  schedule.at(at_ms(5000));
  EXPECT_EQ(schedule.add({at_ms(5000), kStarboard}, at_ms(5000)), CommandVerdict::kTaken);
  EXPECT_EQ(schedule.at(at_ms(5000)), kStarboard);
  EXPECT_FALSE(schedule.is_safe_state());
}

TEST(CommandSchedule, CommandsTakeTheirTurnHoweverTheyCome) {
  CommandSchedule schedule(kTimeout);
  EXPECT_EQ(schedule.add({at_ms(200), kStarboard}, at_ms(0)), CommandVerdict::kTaken);
  EXPECT_EQ(schedule.add({at_ms(100), kPort}, at_ms(0)), CommandVerdict::kTaken);
  EXPECT_EQ(schedule.at(at_ms(150)), kPort);
  EXPECT_EQ(schedule.at(at_ms(250)), kStarboard);
}

TEST(CommandSchedule, OfTwoForOneInstantTheOneReceivedLaterCounts) {
  CommandSchedule schedule(kTimeout);
  EXPECT_EQ(schedule.add({at_ms(100), kPort}, at_ms(0)), CommandVerdict::kTaken);
  EXPECT_EQ(schedule.add({at_ms(100), kStarboard}, at_ms(0)), CommandVerdict::kTaken);
  EXPECT_EQ(schedule.at(at_ms(100)), kStarboard);
}

TEST(CommandSchedule, WhatIsTooOldIsRefused) {
  CommandSchedule schedule(kTimeout);
  EXPECT_EQ(schedule.add({at_ms(999), kPort}, at_ms(3000)), CommandVerdict::kTooOld);
  EXPECT_EQ(schedule.add({at_ms(2900), kPort}, at_ms(3000)), CommandVerdict::kTaken);
  EXPECT_EQ(schedule.at(at_ms(3000)), kPort);
  EXPECT_EQ(schedule.add({at_ms(2800), kStarboard}, at_ms(3000)), CommandVerdict::kTooOld);  // overtaken
  EXPECT_EQ(schedule.at(at_ms(3010)), kPort);
}

TEST(CommandSchedule, AFloodOfFutureCommandsIsBounded) {
  CommandSchedule schedule(kTimeout);
  for (std::size_t i = 0; i < CommandSchedule::kMaxWaiting; ++i) {
    ASSERT_EQ(schedule.add({at_ms(100 + static_cast<std::int64_t>(i)), kPort}, at_ms(0)),
              CommandVerdict::kTaken);
  }
  EXPECT_EQ(schedule.add({at_ms(50), kPort}, at_ms(0)), CommandVerdict::kTooMany);
}

TEST(CommandSchedule, ATimeoutMustBePositive) {
  EXPECT_THROW(CommandSchedule{SimDuration()}, InvalidArgument);
}

}  // namespace
}  // namespace halocline::vehicle_sim
