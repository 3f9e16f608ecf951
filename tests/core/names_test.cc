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

}  // namespace
}  // namespace halocline
