// SPDX-License-Identifier: BSD-3-Clause
// Rays over bottoms of steep facets, where most rays turn back and those that arrive come through narrow
// windows, against a dense fan of plainly followed rays.
//
// A short set runs by default; HALOCLINE_RAY_LINKS and HALOCLINE_RAY_FAN as in ray_random_links_test.cc.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/random.h"
#include "tests/acoustics/rays/brute_fan.h"
#include "tests/acoustics/rays/brute_ray.h"
#include "tests/acoustics/rays/eigenray_comparison.h"
#include "tests/acoustics/rays/ray_reference.h"

namespace halocline::acoustics {
namespace {

struct SteepBottom {
  const char* name;
  std::vector<ProfiledDepth> bottom;
  int links;
};

int from_environment(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::atoi(text) : otherwise;
}

// Teeth of 15 degrees, 27 m high.
std::vector<ProfiledDepth> sawtooth() {
  std::vector<ProfiledDepth> points;
  for (int i = 0; i <= 40; ++i)
    points.push_back({100.0 * i, i % 2 == 0 ? 100 : 100 - 100 * std::tan(to_radians(15))});
  return points;
}

const double kCanyonWall = 150 / std::tan(to_radians(30)), kRidgeWall = 140 / std::tan(to_radians(35));
const std::vector<ProfiledDepth> kCanyon = {
    {0, 80}, {1200 - kCanyonWall, 80}, {1200, 230}, {1200 + kCanyonWall, 80}};
const std::vector<ProfiledDepth> kRidge = {
    {0, 200}, {1500 - kRidgeWall, 200}, {1500, 60}, {1500 + kRidgeWall, 200}};
const std::vector<SpeedRow> kWater = {{0, 1520}, {50, 1490}, {250, 1492}};

RayLink random_link(const SteepBottom& terrain, std::uint32_t index) {
  const auto draw = [&](std::uint64_t which) {
    return uniform_at({.seed = 5, .purpose = purpose_of("steep bottoms"), .who = index, .which = which});
  };
  const BottomProfile bottom(terrain.bottom);
  RayLink link{0, 0, 800 + 2200 * draw(1)};
  // A window of some metres between a corner and the receiver may hide between two rays that pass both.
  const auto is_near = [&link](const ProfiledDepth& corner) {
    return std::abs(corner.range_m - link.range_m) < 20;
  };
  while (std::any_of(terrain.bottom.begin(), terrain.bottom.end(), is_near)) link.range_m += 20;
  link.source_depth_m = (0.02 + 0.96 * draw(2)) * bottom.depth_at(0);
  link.receiver_depth_m = (0.02 + 0.96 * draw(3)) * bottom.depth_at(link.range_m);
  return link;
}

class SteepBottoms : public ::testing::TestWithParam<SteepBottom> {};

TEST_P(SteepBottoms, HaveTheEigenraysOfADenseFan) {
  const SteepBottom& terrain = GetParam();
  const RaySea sea = sea_of(kWater, BottomProfile(terrain.bottom));
  // Where every path loses much, the solver looks further than the fan.
  const BruteSea brute{kWater, terrain.bottom, false, sea.bottom, 0.005},
      all{kWater, terrain.bottom, false, sea.bottom, 1e-9};
  ComparisonCount count;
  const int links = from_environment("HALOCLINE_RAY_LINKS", terrain.links);
  for (int i = 0; i < links; ++i) {
    const RayLink link = random_link(terrain, static_cast<std::uint32_t>(i));
    std::vector<BruteEigenray> found;
    for (const Eigenray& path : eigenrays(sea, link).paths) found.push_back(brute_of(path));
    compare_eigenrays(
        std::string(terrain.name) + " link " + std::to_string(i), found,
        brute_eigenrays(brute, link, to_radians(80), from_environment("HALOCLINE_RAY_FAN", 4000)),
        [&](double launch_rad) { return brute_eigenray(all, link, launch_rad); }, count);
  }
  print(terrain.name, count);
  EXPECT_GT(count.expected, 5 * count.links);
}

void PrintTo(const SteepBottom& terrain, std::ostream* out) { *out << terrain.name; }

INSTANTIATE_TEST_SUITE_P(Terrains, SteepBottoms,
                         ::testing::Values(SteepBottom{"sawtooth15", sawtooth(), 8},
                                           SteepBottom{"canyon30", kCanyon, 8},
                                           SteepBottom{"ridge35", kRidge, 8}),
                         [](const auto& terrain) { return std::string(terrain.param.name); });

}  // namespace
}  // namespace halocline::acoustics
