// SPDX-License-Identifier: BSD-3-Clause
#include "tests/layers/name_rules.h"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/layers/source_tree.h"

namespace halocline::layers {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// Without the examples, which stand for programs of others.
std::vector<SourceFile> own_programs() {
  std::vector<SourceFile> sources = sources_below(HALOCLINE_SOURCE_DIR);
  std::erase_if(sources, [](const SourceFile& source) {
    return source.path.starts_with("tests/") || source.path.starts_with("bench/") ||
           source.path.starts_with("clients/examples/");
  });
  return sources;
}

TEST(Names, NoTwoHeadersOfTheTreeShareOne) {
  EXPECT_THAT(shared_header_names(sources_below(HALOCLINE_SOURCE_DIR)), IsEmpty());
}

TEST(Names, NoTwoTypesOfTheProgramsShareOne) { EXPECT_THAT(shared_type_names(own_programs()), IsEmpty()); }

TEST(NameRules, HeadersOfOneNameInTwoFoldersAreFound) {
  EXPECT_THAT(shared_header_names(
                  {{"core/frames.h", ""}, {"core/frames.cc", ""}, {"ocean/a.h", ""}, {"bus/frames.h", ""}}),
              ElementsAre("frames.h: bus/frames.h, core/frames.h"));
}

TEST(NameRules, ATypeOfTwoHeadersIsFoundWhateverItsKind) {
  EXPECT_THAT(shared_type_names({{"core/a.h", "struct Range {\n"}, {"bus/b.h", "using Range = double;\n"}}),
              ElementsAre("Range: bus/b.h, core/a.h"));
  EXPECT_THAT(
      shared_type_names({{"core/a.h", "class Sea : public Water {\n"}, {"bus/b.h", "enum class Sea {\n"}}),
      ElementsAre("Sea: bus/b.h, core/a.h"));
}

TEST(NameRules, DeclarationsNestedTypesAndSourceFilesAreNoSecondType) {
  EXPECT_THAT(shared_type_names({{"core/a.h", "struct Range {\n};\n"},
                                 {"core/b.h", "struct Range;  // in a.h\n"},
                                 {"core/c.h", "class Sea {\n  struct Range {\n  };\n};\n"},
                                 {"core/d.h", "class Range::Cursor {\n};\n"},
                                 {"core/e.cc", "struct Range {\n};\n"}}),
              IsEmpty());
}

}  // namespace
}  // namespace halocline::layers
