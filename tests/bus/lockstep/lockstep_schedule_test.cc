// SPDX-License-Identifier: BSD-3-Clause
#include "bus/lockstep/lockstep_schedule.h"

#include <cstdint>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/at_ms.h"

namespace halocline::bus {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

using halocline::testing::at_ms;

TEST(LockstepSchedule, TimeAdvancesToTheEarliestDueInstant) {
  LockstepSchedule schedule;
  const std::vector<ScheduleEntry> entries{{0, at_ms(30)}, {1, at_ms(20)}, {2}};
  EXPECT_EQ(schedule.next_instant(entries), at_ms(20));
}

TEST(LockstepSchedule, AnEntryWithInputStepsAtThePresentInstant) {
  LockstepSchedule schedule;
  schedule.begin(at_ms(5));
  const std::vector<ScheduleEntry> entries{{0, at_ms(30)}, {1, SimTime::never(), true}};
  EXPECT_EQ(schedule.next_instant(entries), at_ms(5));
  EXPECT_THAT(schedule.round(entries), ElementsAre(1));
}

TEST(LockstepSchedule, WithoutDueEntriesItIsNever) {
  EXPECT_EQ(LockstepSchedule().next_instant({}), SimTime::never());
}

TEST(LockstepSchedule, AllOfAStageStepTogetherAndStagesInTheirOrder) {
  LockstepSchedule schedule;
  schedule.begin(at_ms(10));
  std::vector<ScheduleEntry> entries{{1, at_ms(10)}, {1, at_ms(11)}, {1, at_ms(10)}, {4, at_ms(10)}};
  EXPECT_THAT(schedule.round(entries), ElementsAre(0, 2));
  entries[0].due = entries[2].due = SimTime::never();
  EXPECT_THAT(schedule.round(entries), ElementsAre(3));
  entries[3].due = SimTime::never();
  EXPECT_THAT(schedule.round(entries), IsEmpty());
}

TEST(LockstepSchedule, AnEarlierStageThatIsDueAgainWaitsForTheNextPass) {
  LockstepSchedule schedule;
  schedule.begin(at_ms(10));
  const std::vector<ScheduleEntry> entries{{1, at_ms(10)}, {2, at_ms(10)}};
  for (int pass = 0; pass < 3; ++pass) {
    EXPECT_THAT(schedule.round(entries), ElementsAre(0));
    EXPECT_THAT(schedule.round(entries), ElementsAre(1));
  }
}

TEST(LockstepSchedule, AnInstantThatNeverEndsIsAnError) {
  LockstepSchedule schedule;
  schedule.begin(at_ms(10));
  const std::vector<ScheduleEntry> entries{{1, at_ms(10)}};
  const auto keep_asking = [&] {
    while (!schedule.round(entries).empty()) {
    }
  };
  EXPECT_THROW(keep_asking(), std::runtime_error);
}

TEST(LookaheadAlone, IsTheEarliestInstantAtWhichAnotherMayPublish) {
  const std::vector<ScheduleEntry> entries{{0, at_ms(10)}, {1, at_ms(70)}, {2, at_ms(40)}};
  EXPECT_EQ(lookahead_alone(entries, 0), at_ms(40));
  EXPECT_EQ(lookahead_alone(entries, 2), at_ms(10));
  EXPECT_EQ(lookahead_alone(std::vector<ScheduleEntry>{{0, at_ms(10)}}, 0), SimTime::never());
}

TEST(LookaheadAlone, IsThePresentWhileAnotherHasInput) {
  const std::vector<ScheduleEntry> entries{{0, at_ms(10)}, {1, at_ms(70), true}};
  EXPECT_EQ(lookahead_alone(entries, 0), SimTime::at_once());
}

TEST(SharedLookahead, IsBoundedByOthersThatAreDueAndByWhoOfTheStagePromisedLeast) {
  const SimTime never = SimTime::never();
  const std::vector<ScheduleEntry> entries{
      {0, at_ms(60)}, {6, at_ms(10), false, at_ms(50)}, {6, at_ms(12), false, at_ms(40)}, {6, never}};
  EXPECT_EQ(shared_lookahead(entries, 6, at_ms(10)), at_ms(40));
  EXPECT_EQ(shared_lookahead(entries, 0, at_ms(10)), at_ms(10));
  EXPECT_EQ(shared_lookahead(std::vector<ScheduleEntry>{{6, at_ms(10), false, never}}, 6, at_ms(10)),
            at_ms(10) + kLongestSharedLookahead);
}

TEST(SharedLookahead, IsThePresentWhereOneHasInputOrPromisesNothing) {
  const SimTime never = SimTime::never();
  EXPECT_LE(
      shared_lookahead(std::vector<ScheduleEntry>{{6, at_ms(10), false, never}, {6, never, true, never}}, 6,
                       at_ms(10)),
      at_ms(10));
  EXPECT_LE(
      shared_lookahead(std::vector<ScheduleEntry>{{6, at_ms(10)}, {6, never, false, never}}, 6, at_ms(10)),
      at_ms(10));
}

}  // namespace
}  // namespace halocline::bus
