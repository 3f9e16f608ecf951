// SPDX-License-Identifier: BSD-3-Clause
#include "tests/layers/size_rules.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/layers/source_tree.h"

namespace halocline::layers {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const std::vector<SourceFile>& tree() {
  static const std::vector<SourceFile> sources = sources_below(HALOCLINE_SOURCE_DIR);
  return sources;
}

TEST(Sizes, NoFileOfTheTreeIsTooLong) { EXPECT_THAT(long_files(tree()), IsEmpty()); }

TEST(Sizes, NoFolderOfTheTreeHoldsTooManyFiles) { EXPECT_THAT(full_folders(tree()), IsEmpty()); }

TEST(Sizes, EachFolderOfTheTreeHasAReadme) {
  EXPECT_THAT(folders_without_readme(tree(), files_below(HALOCLINE_SOURCE_DIR)), IsEmpty());
}

TEST(Sizes, NoClassOfTheTreeLiesInTwoSourceFiles) { EXPECT_THAT(split_classes(tree()), IsEmpty()); }

TEST(SizeRules, LinesAreCountedByKindOfFile) {
  const std::string lines(251, '\n');
  EXPECT_THAT(long_files({{"core/a.h", lines}, {"core/a.cc", lines}, {"core/b.cc", std::string(451, '\n')}}),
              ElementsAre("core/a.h: 251 lines, at most 250", "core/b.cc: 451 lines, at most 450"));
}

TEST(SizeRules, AFolderCountsItsOwnFilesAlone) {
  std::vector<SourceFile> sources;
  for (int i = 0; i < 36; ++i) sources.push_back({"bus/f" + std::to_string(i) + ".cc", ""});
  for (int i = 0; i < 35; ++i) sources.push_back({"bus/logs/f" + std::to_string(i) + ".cc", ""});
  EXPECT_THAT(full_folders(sources), ElementsAre("bus: 36 source files, at most 35"));
}

TEST(SizeRules, AFolderOfSourcesWithoutAReadmeIsFound) {
  const std::vector<SourceFile> sources{
      {"acoustics/sea/a.cc", ""}, {"bus/a.h", ""}, {"bus/b.cc", ""}, {"core/a.h", ""}};
  EXPECT_THAT(folders_without_readme(sources, {"README.md", "acoustics/README.md", "core/README.md"}),
              ElementsAre("acoustics/sea: no README.md", "bus: no README.md"));
}

TEST(SizeRules, TestsAndBenchmarksNeedNoReadme) {
  EXPECT_THAT(folders_without_readme({{"tests/core/a.cc", ""}, {"bench/bus/a.cc", ""}}, {}), IsEmpty());
}

TEST(SizeRules, AClassOfTwoSourceFilesIsFound) {
  EXPECT_THAT(split_classes({{"core/a.cc", "A::A(int x) : x_(x) {}\n"},
                             {"core/b.cc", "std::vector<int> A::of(int x) const {\n"}}),
              ElementsAre("A: core/a.cc, core/b.cc"));
  EXPECT_THAT(split_classes({{"core/a.cc", "void A::B::f() {}\n"}, {"core/b.cc", "A::B::~B() {}\n"}}),
              ElementsAre("A::B: core/a.cc, core/b.cc"));
  EXPECT_THAT(
      split_classes({{"core/a.cc", "bool A::operator==(const A& b) {}\n"}, {"core/b.cc", "int A::f() {}\n"}}),
      ElementsAre("A: core/a.cc, core/b.cc"));
}

TEST(SizeRules, UsesOfAClassAndLocalClassesAreNoDefinitions) {
  EXPECT_THAT(
      split_classes({{"core/a.cc", "A::A() {}\n"},
                     {"core/b.cc", "const A kA = A::of(3);\n  A::of(4);\n// A::of(5)\nint f(A::B b) {}\n"},
                     {"core/c.cc", "class A {\n};\nvoid A::f() {}\n"},
                     {"bus/a.cc", "void A::f() {}\n"}}),
      IsEmpty());
}

}  // namespace
}  // namespace halocline::layers
