#include "bus/sequence_watch.h"

#include <gtest/gtest.h>

namespace halocline::bus {
namespace {

TEST(SequenceWatch, TheFirstAndTheNextMissNothing) {
  SequenceWatch watch;
  EXPECT_EQ(watch.missing_before("A", 1, 40), 0);
  EXPECT_EQ(watch.missing_before("A", 1, 41), 0);
}

TEST(SequenceWatch, AGapIsCountedOnce) {
  SequenceWatch watch;
  watch.missing_before("A", 1, 0);
  EXPECT_EQ(watch.missing_before("A", 1, 5), 4);
  EXPECT_EQ(watch.missing_before("A", 1, 6), 0);
}

TEST(SequenceWatch, RepetitionsAndLatecomersAreNoGaps) {
  SequenceWatch watch;
  watch.missing_before("A", 1, 5);
  EXPECT_EQ(watch.missing_before("A", 1, 5), 0);
  EXPECT_EQ(watch.missing_before("A", 1, 2), 0);
  EXPECT_EQ(watch.missing_before("A", 1, 6), 0);
}

TEST(SequenceWatch, ANewSessionStartsAnew) {
  SequenceWatch watch;
  watch.missing_before("A", 1, 100);
  EXPECT_EQ(watch.missing_before("A", 2, 0), 0);
  EXPECT_EQ(watch.missing_before("A", 2, 2), 1);
}

TEST(SequenceWatch, TwoPublishersOnOneChannelAreFollowedApart) {
  SequenceWatch watch;
  watch.missing_before("A", 1, 0);
  watch.missing_before("A", 2, 50);
  EXPECT_EQ(watch.missing_before("A", 1, 1), 0);
  EXPECT_EQ(watch.missing_before("A", 2, 52), 1);
}

TEST(SequenceWatch, ChannelsAreFollowedApart) {
  SequenceWatch watch;
  watch.missing_before("A", 1, 0);
  watch.missing_before("B", 1, 10);
  EXPECT_EQ(watch.missing_before("A", 1, 1), 0);
}

TEST(SequenceWatch, APublisherThatKeepsNoNumbersIsNotWatched) {
  SequenceWatch watch;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(watch.missing_before("A", 0, 0), 0);
}

TEST(SequenceWatch, RemembersTheSessionHeardLastAmongMany) {
  SequenceWatch watch;
  watch.missing_before("A", 1, 0);  // the smallest number of all, but heard again and again
  for (int session = 100; session < 130; ++session) {
    watch.missing_before("A", 1, session - 99);
    watch.missing_before("A", session, 0);
  }
  EXPECT_EQ(watch.missing_before("A", 1, 35), 4);
}

TEST(SequenceWatch, HostileNumbersDoNotOverflow) {
  SequenceWatch watch;
  watch.missing_before("A", 1, INT64_MIN);
  EXPECT_GE(watch.missing_before("A", 1, INT64_MAX), 0);
  EXPECT_EQ(watch.missing_before("A", 1, INT64_MIN), 0);
}

}  // namespace
}  // namespace halocline::bus
