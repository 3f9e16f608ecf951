// SPDX-License-Identifier: BSD-3-Clause
#include "tests/layers/source_tree.h"

#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace halocline::layers {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<std::string> paths_in(std::string_view source) {
  std::vector<std::string> paths;
  for (const Include& include : includes_of(source)) paths.push_back(include.path);
  return paths;
}

TEST(SourceTree, IsThere) { EXPECT_GT(sources_below(HALOCLINE_SOURCE_DIR).size(), 50u); }

TEST(SourceTree, ReadsQuotesAndBrackets) {
  EXPECT_THAT(paths_in("#include \"bus/bus.h\"\n#include <lcm/lcm-cpp.hpp>\n"),
              ElementsAre("bus/bus.h", "lcm/lcm-cpp.hpp"));
}

TEST(SourceTree, ReadsEverySpelling) {
  for (const char* line : {"  #include <lcm/lcm.h>", "# include <lcm/lcm.h>", "#\tinclude<lcm/lcm.h>",
                           "#include/**/<lcm/lcm.h>", "/* why */ #include <lcm/lcm.h>  // for a clock",
                           "#include \\\n  <lcm/lcm.h>", "#\\\ninclude <lcm/lcm.h>", "%:include <lcm/lcm.h>",
                           "#import <lcm/lcm.h>", "#include <lcm/lcm.h>\r"}) {
    EXPECT_THAT(paths_in(line), ElementsAre("lcm/lcm.h")) << line;
  }
}

TEST(SourceTree, LeavesCommentsOut) {
  EXPECT_THAT(paths_in("// #include <thread>\n/* #include <thread>\n#include <chrono>\n*/\nint a;  /**/\n"),
              IsEmpty());
}

TEST(SourceTree, CountsLinesThroughComments) {
  const auto includes =
      includes_of("/* one\ntwo */\n\n#include <lcm/lcm.h>\n#include \\\n <a>\n#include <b>\n");
  ASSERT_EQ(includes.size(), 3u);
  EXPECT_EQ(includes[0].line, 4);
  EXPECT_EQ(includes[1].line, 5);
  EXPECT_EQ(includes[2].line, 7);
}

TEST(SourceTree, SurvivesAnUnfinishedCommentAndAnUnfinishedPath) {
  EXPECT_THAT(paths_in("#include <a"), ElementsAre("<a"));
  EXPECT_THAT(paths_in("/*"), IsEmpty());
  EXPECT_THAT(paths_in("//"), IsEmpty());
  EXPECT_THAT(paths_in("#include"), IsEmpty());
}

}  // namespace
}  // namespace halocline::layers
