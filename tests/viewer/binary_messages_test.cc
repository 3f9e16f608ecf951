// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/pages/binary_messages.h"

#include <cmath>
#include <cstdint>
#include <cstring>

#include <gtest/gtest.h>

#include "core/sim_time.h"
#include "tests/viewer/run_for_pages.h"

namespace halocline::monitor {
namespace {

template <class Number>
Number number_at(const std::string& bytes, std::size_t at) {
  Number number;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

TEST(Frames, VehiclesAreWrittenToTheByte) {
  const std::string bytes = vehicle_frame(testing::small_run(), SimTime::from_seconds(30.5));
  ASSERT_EQ(bytes.size(), 12u + 2 * 36u);
  EXPECT_EQ(bytes.substr(0, 4), std::string("\1\1\2\0", 4));
  EXPECT_EQ(number_at<double>(bytes, 4), 30.5);
  EXPECT_EQ(bytes.substr(12, 4), std::string("\0\0\0\0", 4));
  EXPECT_EQ(number_at<float>(bytes, 16), 30.5F);  // north
  EXPECT_EQ(number_at<float>(bytes, 20), 0.0F);
  EXPECT_EQ(number_at<float>(bytes, 24), 20.0F);         // down
  EXPECT_TRUE(std::isnan(number_at<float>(bytes, 44)));  // no terrain
  EXPECT_EQ(number_at<std::uint16_t>(bytes, 48), 1);
  EXPECT_EQ(number_at<float>(bytes, 56), 1500.0F);  // east of the second
}

TEST(Frames, VehicleWithoutStateIsLeftOutAndOldOneIsMarked) {
  clients::RunTimeline timeline;
  testing::add(timeline, "STATE.auv-2", clients::testing::state(9, 0, 1));
  testing::add(timeline, "SEND.auv-1", clients::testing::send(4, 0, 0));
  EXPECT_EQ(number_at<std::uint16_t>(vehicle_frame(timeline, SimTime::from_seconds(1)), 2), 1);
  EXPECT_EQ(number_at<std::uint16_t>(vehicle_frame(timeline, SimTime::from_seconds(1)), 14), 0);
  EXPECT_EQ(number_at<std::uint16_t>(vehicle_frame(timeline, SimTime::from_seconds(2.1)), 14), 1);
}

TEST(Frames, TerrainAndLinksAreWrittenToTheByte) {
  const std::string terrain = terrain_frame(
      {.south_m = -10, .west_m = 5, .spacing_m = 2, .rows = 1, .columns = 2, .depth_m = {7, NAN}}, 65538);
  ASSERT_EQ(terrain.size(), 20u + 8u);
  EXPECT_EQ(terrain.substr(0, 8), std::string("\2\1\1\0\2\0\2\0", 8));
  EXPECT_EQ(number_at<float>(terrain, 8), -10.0F);
  EXPECT_EQ(number_at<float>(terrain, 16), 2.0F);
  EXPECT_EQ(number_at<float>(terrain, 20), 7.0F);
  const std::string links = link_frame(3, SimTime::from_seconds(2), {{0, 1, 4.5F}});
  ASSERT_EQ(links.size(), 16u + 8u);
  EXPECT_EQ(links.substr(0, 8), std::string("\3\1\3\0\1\0\0\0", 8));
  EXPECT_EQ(number_at<double>(links, 8), 2.0);
  EXPECT_EQ(number_at<std::uint16_t>(links, 18), 1);
  EXPECT_EQ(number_at<float>(links, 20), 4.5F);
}

}  // namespace
}  // namespace halocline::monitor
