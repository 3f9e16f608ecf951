// SPDX-License-Identifier: BSD-3-Clause
// The examples in the headers' comments, compiled.
#include <gtest/gtest.h>

#include "bus/logs/log_reader.h"
#include "core/sim_time.h"
#include "runs/timeline/run_timeline.h"
#include "tests/bus/logs/log_fixture.h"

namespace halocline::clients {
namespace {

TEST(HeaderExamples, ARunTimelineReadsALog) {
  testing::TemporaryLog file;
  file.add(0, "STATE.auv-1", testing::state_at(0));
  file.add(120'000'000, "STATE.auv-1", testing::state_at(120'000'000, 90));
  LogReader log(file.path());
  LoggedEvent event;
  RunTimeline store;
  while (log.next(event)) store.add(event.stamp_us, event.channel, event.data);
  const auto place = state_at(store.vehicles()[0].track, SimTime::from_seconds(60));
  ASSERT_TRUE(place);
  EXPECT_DOUBLE_EQ(place->point.position_ned_m.x(), 45);
}

}  // namespace
}  // namespace halocline::clients
