// SPDX-License-Identifier: BSD-3-Clause
#include "tests/layers/function_rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/layers/source_tree.h"

namespace halocline::layers {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(Functions, NoneOfTheTreeDependsOnTheProcessor) {
  EXPECT_THAT(processor_dependent_calls(sources_below(HALOCLINE_SOURCE_DIR)), IsEmpty());
}

TEST(FunctionRules, CallsAreFoundWithTheirLines) {
  const std::vector<SourceFile> sources{
      {"acoustics/sea/noise.cc",
       "// std::exp(1)\nx = std::pow(2, y) + std::sqrt(z);\n#include <boost/math/tools.hpp>\n"},
      {"vehicle_sim/fleet.cc", "q.slerp(1, p);\nstd::log_of(3); elementary::exp(x);"},
      {"tests/core/a.cc", "std::exp(1)"}};
  EXPECT_THAT(processor_dependent_calls(sources),
              ElementsAre(HasSubstr("noise.cc:2: std::pow;"), HasSubstr("noise.cc:3: boost/math;"),
                          HasSubstr("fleet.cc:1: slerp;")));
}

}  // namespace
}  // namespace halocline::layers
