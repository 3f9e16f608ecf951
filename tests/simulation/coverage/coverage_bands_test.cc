// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/coverage/coverage_bands.h"

#include <limits>

#include <gtest/gtest.h>

#include "simulation/composition.h"
#include "simulation/link_survey.h"

namespace halocline::clients {
namespace {

TEST(CoverageBands, AreQuantilesOfEachCell) {
  ScenarioConfig config;
  config.terrain.flat.depth_m = 100;
  const auto terrain = make_terrain(config).terrain;
  int members = 0;
  // Member k has the level k in its first cell, and no water in its second.
  const auto computed = [&](const ScenarioConfig&) {
    constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
    const double value = members++;
    Coverage map;
    map.delivery = map.delay_s = map.level_db = {{value, kNothing}};
    map.noise_level_db = 2 * value;
    return map;
  };
  const CoverageBands bands = coverage_bands(config, link_end(config, "0,0,10"), *terrain, 5, computed);
  EXPECT_EQ(members, 5);
  EXPECT_DOUBLE_EQ(bands[0].level_db[0][0], 0);
  EXPECT_DOUBLE_EQ(bands[1].level_db[0][0], 2);
  EXPECT_DOUBLE_EQ(bands[2].level_db[0][0], 4);
  // The SNR of member k is k - 2 k.
  EXPECT_DOUBLE_EQ(bands[1].values(CoverageQuantity::kSnr, 0)[0], -2);
  EXPECT_DOUBLE_EQ(bands[2].values(CoverageQuantity::kSnr, 0)[0], 0);
  EXPECT_TRUE(bands[1].level_db[0][1] != bands[1].level_db[0][1]);
}

TEST(CoverageBands, HaveFilesOfTheirOwn) {
  EXPECT_EQ(name_of_band("out/buoy.tif", 0), "out/buoy.10.tif");
  EXPECT_EQ(name_of_band("out/buoy.tif", 2), "out/buoy.90.tif");
}

}  // namespace
}  // namespace halocline::clients
