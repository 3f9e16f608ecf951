// SPDX-License-Identifier: BSD-3-Clause
#include "tests/layers/prose_rules.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/layers/source_tree.h"

namespace halocline::layers {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<SourceFile> programs() {
  std::vector<SourceFile> all = sources_below(HALOCLINE_SOURCE_DIR), programs;
  std::copy_if(all.begin(), all.end(), std::back_inserter(programs), [](const SourceFile& source) {
    return !source.path.starts_with("tests/") && !source.path.starts_with("bench/");
  });
  return programs;
}

TEST(Prose, NoLineOfTheTreeIsTooLong) {
  EXPECT_THAT(long_lines(sources_below(HALOCLINE_SOURCE_DIR)), IsEmpty());
}

TEST(Prose, CommentsOfTheProgramsOpenWithTheirSubject) {
  const Openings counted = openings(programs());
  EXPECT_GT(counted.own, 4000);
  EXPECT_LE(counted.own_bare, kMaxBareShare * counted.own) << ::testing::PrintToString(counted.bare);
  EXPECT_LE(counted.trailing_bare, kMaxBareShare * counted.trailing)
      << ::testing::PrintToString(counted.bare);
}

TEST(ProseRules, ABlockOfCommentLinesIsOneCommentByItsFirstWords) {
  const Openings counted = openings({{"core/a.h",
                                      "// Of the sea.\n// What follows is the same comment.\n"
                                      "int depth_m;  // the depth\n// The sea.\nint x;  // of it\n"}});
  EXPECT_EQ(counted.own, 2);
  EXPECT_EQ(counted.trailing, 2);
  EXPECT_THAT(counted.bare, ElementsAre("core/a.h:1: Of the sea.", "core/a.h:5: of it"));
}

TEST(ProseRules, LinesAreMeasuredInColumns) {
  EXPECT_THAT(long_lines({{"a.cc", "\n" + std::string(110, 'x') + "\n" + std::string(111, 'x')}}),
              ElementsAre("a.cc:3: 111 columns"));
}

}  // namespace
}  // namespace halocline::layers
