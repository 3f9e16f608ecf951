#include "bus/lockstep/lockstep_schedule.h"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace halocline::bus {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

SimTime at_ms(std::int64_t n) { return SimTime() + SimDuration::from_milliseconds(n); }

TEST(LockstepSchedule, TimeGoesToTheEarliestInstantAtWhichSomebodyIsDue) {
  LockstepSchedule schedule;
  const std::vector<LockstepSeat> seats{{0, at_ms(30)}, {1, at_ms(20)}, {2}};
  EXPECT_EQ(schedule.next_instant(seats), at_ms(20));
}

TEST(LockstepSchedule, WhoMustHearIsAskedAtThePresentInstant) {
  LockstepSchedule schedule;
  schedule.begin(at_ms(5));
  const std::vector<LockstepSeat> seats{{0, at_ms(30)}, {1, SimTime::never(), true}};
  EXPECT_EQ(schedule.next_instant(seats), at_ms(5));
  EXPECT_THAT(schedule.round(seats), ElementsAre(1));
}

TEST(LockstepSchedule, NobodyDueIsNever) { EXPECT_EQ(LockstepSchedule().next_instant({}), SimTime::never()); }

TEST(LockstepSchedule, AllOfAStageStepTogetherAndStagesInTheirOrder) {
  LockstepSchedule schedule;
  schedule.begin(at_ms(10));
  std::vector<LockstepSeat> seats{{1, at_ms(10)}, {1, at_ms(11)}, {1, at_ms(10)}, {4, at_ms(10)}};
  EXPECT_THAT(schedule.round(seats), ElementsAre(0, 2));
  seats[0].due = seats[2].due = SimTime::never();
  EXPECT_THAT(schedule.round(seats), ElementsAre(3));
  seats[3].due = SimTime::never();
  EXPECT_THAT(schedule.round(seats), IsEmpty());
}

TEST(LockstepSchedule, AnEarlierStageThatIsDueAgainWaitsForTheNextPass) {
  LockstepSchedule schedule;
  schedule.begin(at_ms(10));
  const std::vector<LockstepSeat> seats{{1, at_ms(10)}, {2, at_ms(10)}};
  for (int pass = 0; pass < 3; ++pass) {
    EXPECT_THAT(schedule.round(seats), ElementsAre(0));
    EXPECT_THAT(schedule.round(seats), ElementsAre(1));
  }
}

TEST(LockstepSchedule, WhoNeverComesToRestIsAnError) {
  LockstepSchedule schedule;
  schedule.begin(at_ms(10));
  const std::vector<LockstepSeat> seats{{1, at_ms(10)}};
  const auto keep_asking = [&] {
    while (!schedule.round(seats).empty()) {
    }
  };
  EXPECT_THROW(keep_asking(), std::runtime_error);
}

TEST(LockstepHorizon, IsTheEarliestInstantAtWhichAnotherMaySpeak) {
  const std::vector<LockstepSeat> seats{{0, at_ms(10)}, {1, at_ms(70)}, {2, at_ms(40)}};
  EXPECT_EQ(lockstep_horizon(seats, 0), at_ms(40));
  EXPECT_EQ(lockstep_horizon(seats, 2), at_ms(10));
  EXPECT_EQ(lockstep_horizon(std::vector<LockstepSeat>{{0, at_ms(10)}}, 0), SimTime::never());
}

TEST(LockstepHorizon, IsThePresentWhileAnotherMustHear) {
  const std::vector<LockstepSeat> seats{{0, at_ms(10)}, {1, at_ms(70), true}};
  EXPECT_EQ(lockstep_horizon(seats, 0), SimTime::at_once());
}

}  // namespace
}  // namespace halocline::bus
