// SPDX-License-Identifier: BSD-3-Clause
#include "bus/messages/channel_pattern.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/bus.h"
#include "core/check.h"

namespace halocline::bus {
namespace {

using ::testing::ElementsAre;

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

// Backtracking would try 2^60 ways.
TEST(ChannelPattern, AMatchTakesLinearTimeWhateverTheExpression) {
  const std::string channel(60, 'a');
  for (const char* expression : {"(a*)*b", "(a|a)+b", "(a+)+\\.x", "(.*a){20}b", "((a{0,30}){0,30}){0,1}b"})
    EXPECT_FALSE(ChannelPattern(expression).matches(channel)) << expression;
  EXPECT_TRUE(ChannelPattern("(a*)*b").matches(channel + "b"));
}

TEST(ChannelPattern, AnExpressionThatNeedsMuchMemoryIsRefused) {
  EXPECT_THROW(ChannelPattern("((a{1000}){1000}){1000}"), InvalidArgument);
  EXPECT_THROW(ChannelPattern("(((.{30}){30}){30})b"), InvalidArgument);
}

TEST(ChannelPattern, AnyByteIsACharacter) {
  EXPECT_TRUE(ChannelPattern("a.\\.(b|c)").matches("a\xff.b"));
  EXPECT_TRUE(ChannelPattern("(\xe9|x)").matches("\xe9"));
}

TEST(ChannelPatterns, AChannelHasThePlacesOfThoseThatMatchIt) {
  ChannelPatterns patterns;
  for (const char* expression : {"SEND\\.a", "STATE\\..*", "SEND\\.b", "(SEND|STATE)\\.a", "SEND\\.a", ".*"})
    patterns.add(expression);
  EXPECT_THAT(patterns.matching("SEND.a"), ElementsAre(0, 3, 4, 5));
  EXPECT_THAT(patterns.matching("SEND.b"), ElementsAre(2, 5));
  EXPECT_THAT(patterns.matching("STATE.a"), ElementsAre(1, 3, 5));
  EXPECT_THAT(patterns.matching("SEND.ab"), ElementsAre(5));
  EXPECT_THAT(ChannelPatterns().matching("SEND.a"), ElementsAre());
}

TEST(Escaped, EverySpecialCharacterIsEscaped) {
  EXPECT_EQ(escaped(R"(a.b*c+(d)[e]{f}^g$h|i?j\k)"), R"(a\.b\*c\+\(d\)\[e\]\{f\}\^g\$h\|i\?j\\k)");
  EXPECT_EQ(escaped("plain_NAME-1"), "plain_NAME-1");
}

}  // namespace
}  // namespace halocline::bus
