#include "vehicle_sim/altimeter_desk.h"

#include <gtest/gtest.h>

namespace halocline::vehicle_sim {
namespace {

SimTime at_ms(std::int64_t ms) { return SimTime::from_utime(ms * 1000); }

TEST(AltimeterDesk, AnAnsweredTickLeavesAtOnce) {
  AltimeterDesk desk;
  desk.wait(7, {at_ms(100), {0}, {{}}}, at_ms(350));
  EXPECT_FALSE(desk.take(at_ms(100)));
  EXPECT_EQ(desk.next_deadline(), at_ms(350));
  SensorTick* tick = desk.answer(7);
  ASSERT_NE(tick, nullptr);
  tick->readings[0].altitude_m = 12;
  EXPECT_TRUE(desk.has_complete());
  const auto taken = desk.take(at_ms(100));
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->readings[0].altitude_m, 12);
  EXPECT_EQ(desk.given_up(), 0);
}

TEST(AltimeterDesk, AnUnansweredTickLeavesAtItsDeadline) {
  AltimeterDesk desk;
  desk.wait(7, {at_ms(100), {}, {}}, at_ms(350));
  EXPECT_FALSE(desk.take(at_ms(349)));
  EXPECT_TRUE(desk.take(at_ms(350)));
  EXPECT_EQ(desk.given_up(), 1);
  EXPECT_EQ(desk.answer(7), nullptr);  // too late
  EXPECT_EQ(desk.next_deadline(), SimTime::never());
}

TEST(AltimeterDesk, TicksLeaveInTheOrderOfTheirTime) {
  AltimeterDesk desk;
  desk.wait(1, {at_ms(100), {}, {}}, at_ms(350));
  desk.wait(2, {at_ms(200), {}, {}}, at_ms(450));
  desk.answer(2);
  EXPECT_FALSE(desk.take(at_ms(300)));  // the later waits behind the earlier
  desk.answer(1);
  EXPECT_EQ(desk.take(at_ms(300))->when, at_ms(100));
  EXPECT_EQ(desk.take(at_ms(300))->when, at_ms(200));
}

TEST(AltimeterDesk, AnAnswerCountsOnce) {
  AltimeterDesk desk;
  desk.wait(1, {at_ms(100), {}, {}}, at_ms(350));
  EXPECT_NE(desk.answer(1), nullptr);
  EXPECT_EQ(desk.answer(1), nullptr);
  EXPECT_EQ(desk.answer(9), nullptr);
}

}  // namespace
}  // namespace halocline::vehicle_sim
