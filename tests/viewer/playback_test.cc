// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/pages/playback.h"

#include <gtest/gtest.h>

#include "core/sim_time.h"

namespace halocline::monitor {
namespace {

const SimTime kBegin = SimTime::from_seconds(10), kEnd = SimTime::from_seconds(70);

TEST(Playback, LogStandsAtItsBeginningUntilItIsPlayed) {
  Playback playback(false);
  playback.advance(100, kBegin, kEnd);
  playback.advance(105, kBegin, kEnd);
  EXPECT_EQ(playback.at(), kBegin);
  playback.play(kBegin, kEnd);
  playback.set_speed(2);
  playback.advance(108, kBegin, kEnd);
  EXPECT_EQ(playback.at(), SimTime::from_seconds(16));
}

TEST(Playback, LogStopsAtItsEndAndBeginsAgain) {
  Playback playback(false);
  playback.seek(SimTime::from_seconds(69));
  playback.play(kBegin, kEnd);
  playback.advance(0, kBegin, kEnd);
  playback.advance(5, kBegin, kEnd);
  EXPECT_EQ(playback.at(), kEnd);
  EXPECT_FALSE(playback.is_playing());
  playback.play(kBegin, kEnd);
  playback.advance(5, kBegin, kEnd);
  EXPECT_EQ(playback.at(), kBegin);
}

TEST(Playback, BusFollowsItsEndUntilSeek) {
  Playback playback(true);
  playback.advance(0, kBegin, kEnd);
  EXPECT_EQ(playback.at(), kEnd);
  playback.seek(SimTime::from_seconds(20));
  playback.advance(1, kBegin, kEnd + SimDuration::from_seconds(1));
  EXPECT_EQ(playback.at(), SimTime::from_seconds(21));
  EXPECT_FALSE(playback.is_live());
  playback.follow();
  playback.advance(2, kBegin, kEnd + SimDuration::from_seconds(2));
  EXPECT_EQ(playback.at(), kEnd + SimDuration::from_seconds(2));
}

TEST(Playback, StaysWithinWhatIsKept) {
  Playback playback(true);
  playback.seek(SimTime::from_seconds(0));
  playback.pause();
  playback.advance(0, kBegin, kEnd);
  EXPECT_EQ(playback.at(), kBegin);
  playback.seek(SimTime::from_seconds(1000));
  playback.advance(1, kBegin, kEnd);
  EXPECT_EQ(playback.at(), kEnd);
}

}  // namespace
}  // namespace halocline::monitor
