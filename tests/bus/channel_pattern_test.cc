#include "bus/channel_pattern.h"

#include <gtest/gtest.h>

#include "bus/bus.h"
#include "core/check.h"

namespace halocline::bus {
namespace {

TEST(ChannelPattern, AnEscapedChannelMatchesItselfAlone) {
  const ChannelPattern pattern(escaped("STATE.auv-1"));
  EXPECT_TRUE(pattern.matches("STATE.auv-1"));
  EXPECT_FALSE(pattern.matches("STATEXauv-1"));
  EXPECT_FALSE(pattern.matches("STATE.auv-12"));
}

TEST(ChannelPattern, AFamilyMatchesItsMembers) {
  const ChannelPattern pattern(escaped("STATE.") + ".*");
  EXPECT_TRUE(pattern.matches("STATE.auv-1"));
  EXPECT_FALSE(pattern.matches("ESTATE.auv-1"));
}

TEST(ChannelPattern, AnyOtherExpressionMatchesTheWholeChannel) {
  EXPECT_TRUE(ChannelPattern(".*").matches("STATE.a"));
  const ChannelPattern pattern("(STATE|SEND)\\..+");
  EXPECT_TRUE(pattern.matches("SEND.a"));
  EXPECT_FALSE(pattern.matches("XSEND.a"));
  EXPECT_FALSE(pattern.matches("SEND."));
}

TEST(ChannelPattern, WhatIsNoExpressionIsRefused) { EXPECT_THROW(ChannelPattern("(STATE"), InvalidArgument); }

TEST(ChannelPatterns, MatchWhatOneOfThemDoesAlsoOnceAsked) {
  ChannelPatterns patterns;
  patterns.add("STATE\\..*");
  EXPECT_TRUE(patterns.match("STATE.a"));
  EXPECT_FALSE(patterns.match("SEND.a"));
  EXPECT_FALSE(patterns.match("SEND.a"));
  patterns.add("SEND\\.a");
  EXPECT_TRUE(patterns.match("SEND.a"));
  EXPECT_TRUE(patterns.match("STATE.a"));
  EXPECT_FALSE(patterns.match("SEND.b"));
}

}  // namespace
}  // namespace halocline::bus
