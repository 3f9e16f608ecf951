// SPDX-License-Identifier: BSD-3-Clause
#include "core/shared_module.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/check.h"

namespace halocline {
namespace {

using ::testing::HasSubstr;

std::string error_of(const std::string& file, const std::string& symbol) {
  try {
    module_symbol(file, symbol);
    return "";
  } catch (const InvalidArgument& error) {
    return error.what();
  }
}

TEST(SharedModule, BesideTheProgramsIsFoundFromATest) {
  EXPECT_NE(module_symbol("halocline_rasters.so", "halocline_open_raster"), nullptr);
}

TEST(SharedModule, ThatIsAbsentIsAnErrorThatNamesIt) {
  const std::string error = error_of("halocline_absent.so", "f");
  EXPECT_THAT(error, HasSubstr("the module halocline_absent.so cannot be loaded"));
  EXPECT_THAT(error, HasSubstr("No such file"));
}

TEST(SharedModule, WithoutTheSymbolIsAnErrorThatNamesBoth) {
  EXPECT_EQ(error_of("halocline_rasters.so", "absent"),
            "the module halocline_rasters.so is of another version: it lacks absent");
}

}  // namespace
}  // namespace halocline
