// SPDX-License-Identifier: BSD-3-Clause
#include "bus/logs/log_rotation.h"

#include <gtest/gtest.h>

#include "core/check.h"
#include "core/sim_time.h"

namespace halocline::clients {
namespace {

TEST(LogRotationOption, SizesAndTimesHaveUnits) {
  const bus::LogRotation rotation = rotation_of({"256MB", "1.5h"}, 4);
  EXPECT_EQ(rotation.part_bytes, 256'000'000);
  EXPECT_EQ(rotation.part_time, SimDuration::from_seconds(5400));
  EXPECT_EQ(rotation.parts_kept, 4);
  EXPECT_EQ(rotation_of({"90s"}, 0).part_time, SimDuration::from_seconds(90));
  EXPECT_EQ(rotation_of({"2min"}, 0).part_time, SimDuration::from_seconds(120));
}

TEST(LogRotationOption, WhatIsNeitherIsRefused) {
  for (const char* text : {"", "MB", "10", "0MB", "-1s", "1e30GB", "10 apples"})
    EXPECT_THROW(rotation_of({text}, 0), InvalidArgument) << text;
}

TEST(LogRotationOption, KeepingPartsOfALogThatIsNeverCutIsRefused) {
  EXPECT_THROW(rotation_of({}, 3), InvalidArgument);
}

}  // namespace
}  // namespace halocline::clients
