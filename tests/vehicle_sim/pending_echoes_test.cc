// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/pending_echoes.h"

#include <gtest/gtest.h>

#include "tests/support/at_ms.h"
#include "vehicle_sim/sensors/doppler_log.h"
#include "vehicle_sim/sensors/sensors.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::at_ms;

// With one beam.
SensorTick a_tick(std::int64_t ms) { return {at_ms(ms), {SensorJob{}}, {EchoBeam{}}, {Echo{}}}; }

TEST(PendingEchoes, AnAnsweredTickLeavesAtOnce) {
  PendingEchoes desk;
  desk.wait(7, a_tick(100), at_ms(350));
  EXPECT_FALSE(desk.take(at_ms(100)));
  EXPECT_EQ(desk.next_deadline(), at_ms(350));
  SensorTick* tick = desk.answer(7);
  ASSERT_NE(tick, nullptr);
  tick->echoes[0].range_m = 12;
  EXPECT_TRUE(desk.has_complete());
  const auto taken = desk.take(at_ms(100));
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->echoes[0].range_m, 12);
  EXPECT_EQ(desk.expired(), 0);
}

TEST(PendingEchoes, AnUnansweredTickLeavesAtItsDeadline) {
  PendingEchoes desk;
  desk.wait(7, a_tick(100), at_ms(350));
  EXPECT_FALSE(desk.take(at_ms(349)));
  EXPECT_TRUE(desk.take(at_ms(350)));
  EXPECT_EQ(desk.expired(), 1);
  EXPECT_EQ(desk.answer(7), nullptr);  // too late
  EXPECT_EQ(desk.next_deadline(), SimTime::never());
}

TEST(PendingEchoes, TicksLeaveInTheOrderOfTheirTime) {
  PendingEchoes desk;
  desk.wait(1, a_tick(100), at_ms(350));
  desk.wait(2, a_tick(200), at_ms(450));
  EXPECT_NE(desk.answer(2), nullptr);
  EXPECT_FALSE(desk.take(at_ms(300)));  // the later waits behind the earlier
  EXPECT_NE(desk.answer(1), nullptr);
  EXPECT_EQ(desk.take(at_ms(300))->when, at_ms(100));
  EXPECT_EQ(desk.take(at_ms(300))->when, at_ms(200));
}

TEST(PendingEchoes, AnAnswerCountsOnce) {
  PendingEchoes desk;
  desk.wait(1, a_tick(100), at_ms(350));
  EXPECT_NE(desk.answer(1), nullptr);
  EXPECT_EQ(desk.answer(1), nullptr);
  EXPECT_EQ(desk.answer(9), nullptr);
}

TEST(PendingEchoes, ATickWithoutBeamsIsComplete) {
  PendingEchoes desk;
  desk.wait(1, {at_ms(100), {SensorJob{}}, {}, {}}, at_ms(350));
  EXPECT_TRUE(desk.has_complete());
  EXPECT_TRUE(desk.take(at_ms(100)));
  EXPECT_EQ(desk.expired(), 0);
}

}  // namespace
}  // namespace halocline::vehicle_sim
