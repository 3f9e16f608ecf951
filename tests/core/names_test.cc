// SPDX-License-Identifier: BSD-3-Clause
#include "core/names.h"

#include <gtest/gtest.h>

namespace halocline {
namespace {

TEST(Names, AcceptsLowerCaseDigitsUnderscoreAndHyphen) {
  EXPECT_TRUE(is_valid_name("a"));
  EXPECT_TRUE(is_valid_name("auv-1_b"));
  EXPECT_TRUE(is_valid_name("abcdefghijklmnopqrstuvwx"));
}

TEST(Names, RefusesWhatARegularExpressionOrAFileSystemWouldRead) {
  for (const char* bad : {"", "Auv", "a.b", "a/b", "a*", "a b", "abcdefghijklmnopqrstuvwxy", "\xc3\xa9"}) {
    EXPECT_FALSE(is_valid_name(bad)) << bad;
  }
}

TEST(Names, ALineHasNoControlCharacters) {
  for (const char* line : {"", "a b", "~", "\xc3\xa9", "\xe2\x82\xac", "\xc2\xa0"})
    EXPECT_TRUE(is_one_line(line)) << line;
  for (const char* bad : {"a\nb", "\x1b[2J", "\x7f", "\t", "\r",
                          "\xc2\x9b"
                          "2J"})
    EXPECT_FALSE(is_one_line(bad)) << bad;
}

TEST(Names, ControlCharactersButLineEndsAreReplaced) {
  EXPECT_EQ(without_controls("a\n\x1b[2J\t\xc3\xa9\x7f"), "a\n?[2J?\xc3\xa9?");
  EXPECT_TRUE(
      is_one_line(without_controls("\xc2\x9b"
                                   "2J")));
}

}  // namespace
}  // namespace halocline
