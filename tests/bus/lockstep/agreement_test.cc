// SPDX-License-Identifier: BSD-3-Clause
#include "bus/lockstep/agreement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace halocline::bus {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(Agreement, EqualProgramsWithEqualScenariosAgree) {
  EXPECT_EQ(disagreement(agreement_on("17"), agreement_on("17")), "");
  EXPECT_EQ(disagreement("", ""), "");
}

TEST(Agreement, WhatDiffersIsNamed) {
  EXPECT_THAT(disagreement(agreement_on("17"), agreement_on("18")),
              AllOf(HasSubstr("scenario is '17', not '18'"), Not(HasSubstr("arithmetic")),
                    Not(HasSubstr("version"))));
  const std::string differing =
      disagreement("version=1 messages=2 arithmetic=3", "version=1 messages=4 arithmetic=5");
  EXPECT_THAT(differing, AllOf(HasSubstr("messages (its types"), HasSubstr("arithmetic (its elementary"),
                               Not(HasSubstr("version"))));
}

TEST(Agreement, WhoStatesLessOrMoreDoesNotAgree) {
  EXPECT_THAT(disagreement("scenario=1", "scenario=1 version=2"), HasSubstr("version is not given"));
  EXPECT_NE(disagreement("scenario=1 weather=2", "scenario=1"), "");
  EXPECT_NE(disagreement("", "scenario=1"), "");
}

}  // namespace
}  // namespace halocline::bus
