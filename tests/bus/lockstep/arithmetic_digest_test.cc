// SPDX-License-Identifier: BSD-3-Clause
#include "bus/lockstep/arithmetic_digest.h"

#include <gtest/gtest.h>

namespace halocline::bus {
namespace {

// Of g++ and clang, with and without FMA, on amd64 and arm64. Where it is another, results are other bytes.
TEST(ArithmeticDigest, IsTheSameOnEveryBuild) { EXPECT_EQ(arithmetic_digest(), 17992083441064537121u); }

}  // namespace
}  // namespace halocline::bus
