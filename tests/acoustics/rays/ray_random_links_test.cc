// SPDX-License-Identifier: BSD-3-Clause
// Random links in three waters against a dense fan of plainly followed rays.
//
// A short set runs by default; HALOCLINE_RAY_LINKS=170 runs that many links of each water, and
// HALOCLINE_RAY_FAN=200000 sets the angles of the fan.
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

struct RandomWaters {
  const char* name;
  std::vector<SpeedRow> knots;
  std::vector<ProfiledDepth> bottom;
  bool curved;
  double nearest_m, farthest_m;
  int links, fan;
};

int from_environment(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::atoi(text) : otherwise;
}

std::vector<SpeedRow> munk_knots() {
  std::vector<SpeedRow> knots;
  for (int i = 0; i <= 100; ++i) knots.push_back({50.0 * i, munk_sound_speed_mps(50.0 * i)});
  return knots;
}

// 200 m deep, up to 80 m.
std::vector<ProfiledDepth> gaussian(double step_m, double sigma_m) {
  std::vector<ProfiledDepth> points;
  for (double r = 0; r <= 6000; r += step_m) {
    const double u = (r - 2500) / sigma_m;
    points.push_back({r, 200 - 120 * std::exp(-u * u / 2)});
  }
  return points;
}

class RandomWatersLinks : public ::testing::TestWithParam<RandomWaters> {};

double depth_of(const RandomWaters& waters, double r) { return BottomProfile(waters.bottom).depth_at(r); }

RayLink random_link(const RandomWaters& waters, std::uint32_t index) {
  const auto draw = [&](std::uint64_t which) {
    return uniform_at({.seed = 11, .purpose = purpose_of("random links"), .who = index, .which = which});
  };
  RayLink link{0, 0, waters.nearest_m * std::pow(waters.farthest_m / waters.nearest_m, draw(3))};
  const double at_source = depth_of(waters, 0), at_receiver = depth_of(waters, link.range_m);
  link.source_depth_m = (0.01 + 0.98 * draw(1)) * at_source;
  link.receiver_depth_m = (0.01 + 0.98 * draw(2)) * at_receiver;
  const auto knot = [&](std::uint64_t which, double deepest) {
    const auto inner = static_cast<double>(waters.knots.size() - 2);
    const double depth = waters.knots[1 + static_cast<std::size_t>(draw(which) * inner)].depth_m;
    return depth < deepest ? depth : deepest / 2;
  };
  if (index % 6 == 1) link.receiver_depth_m = std::min(link.source_depth_m, 0.99 * at_receiver);
  if (index % 6 == 2) link.source_depth_m = knot(4, at_source);
  if (index % 7 == 3) link.receiver_depth_m = knot(5, at_receiver);
  // Both ends on the axis of a duct: rays without number that no wave resolves.
  if (index % 6 == 2 && link.receiver_depth_m == link.source_depth_m) link.receiver_depth_m -= 1;
  if (index % 11 == 5) link.receiver_depth_m = at_receiver - 0.5;
  if (index % 11 == 7) link.receiver_depth_m = 0.5;
  return link;
}

void compare_link(const RandomWaters& waters, const RayLink& link, int fan, ComparisonCount& count) {
  const RaySea sea = sea_of(waters.knots, BottomProfile(waters.bottom));
  const BruteSea brute{waters.knots, waters.bottom, waters.curved, sea.bottom, 0.005};
  const std::vector<BruteEigenray> expected = brute_eigenrays(brute, link, to_radians(80), fan);
  const std::string where = std::string(waters.name) + " " + std::to_string(link.source_depth_m) + " " +
                            std::to_string(link.receiver_depth_m) + " " + std::to_string(link.range_m);
  std::vector<RaySolver> solvers = {RaySolver::kArcs};
  if (choose_solver(sea, link) == RaySolver::kSnell) solvers.push_back(RaySolver::kSnell);
  for (const RaySolver solver : solvers) {
    std::vector<BruteEigenray> found;
    for (const Eigenray& path : eigenrays(sea, link, solver).paths) found.push_back(brute_of(path));
    compare_eigenrays(
        where + " by " + std::string(to_name(solver)), found, expected,
        [&](double launch_rad) { return brute_eigenray(brute, link, launch_rad); }, count);
  }
}

TEST(RandomLinks, TheLinkAtAKnotThatAnEarlyBuildMissed) {
  const RandomWaters munk{"munk", munk_knots(), {{0, 5000}}, false, 0, 0, 0, 0};
  ComparisonCount count;
  compare_link(munk, {1650, 2434.53, 91893.275}, 1500, count);
  EXPECT_GT(count.expected, 20);
}

// Where f = (r - b)/X turns beside a barrier of the water but r(xi) of the ray does not, there is no fold.
TEST(RandomLinks, ARayJustOffABarrierHasTheLevelOfItsTube) {
  const RaySea munk = sea_of(munk_knots(), BottomProfile::flat(5000));
  const RayLink link{3387.707867, 2947.485451, 4199.020775};
  const Eigenrays snell = eigenrays(munk, link, RaySolver::kSnell),
                  arcs = eigenrays(munk, link, RaySolver::kArcs);
  // A spherical wave but for 0.1 dB of refraction.
  const double spherical = -20 * std::log10(std::hypot(4199, 440));
  EXPECT_NEAR(20 * std::log10(snell.paths.front().amplitude), spherical, 0.1);
  EXPECT_NEAR(snell.paths.front().amplitude / arcs.paths.front().amplitude, 1, testing::tolerance(1e-6));
}

TEST_P(RandomWatersLinks, HaveTheEigenraysOfADenseFan) {
  const RandomWaters& waters = GetParam();
  const int links = from_environment("HALOCLINE_RAY_LINKS", waters.links);
  const int fan = from_environment("HALOCLINE_RAY_FAN", waters.fan);
  ComparisonCount count;
  for (int i = 0; i < links; ++i)
    compare_link(waters, random_link(waters, static_cast<std::uint32_t>(i)), fan, count);
  print(waters.name, count);
}

const std::vector<SpeedRow> kSummer = {{0, 1520},  {15, 1521}, {25, 1514},  {40, 1500},
                                       {60, 1494}, {90, 1489}, {120, 1491}, {200, 1494}};
// A surface duct of 40 m and a channel below it.
const std::vector<SpeedRow> kDucts = {{0, 1510},   {40, 1510.8}, {55, 1504},  {80, 1496},
                                      {110, 1490}, {160, 1488},  {220, 1490}, {300, 1493}};
const std::vector<SpeedRow> kSeamountWater = {{0, 1520}, {50, 1490}, {200, 1492}};

void PrintTo(const RandomWaters& waters, std::ostream* out) { *out << waters.name; }

INSTANTIATE_TEST_SUITE_P(
    Waters, RandomWatersLinks,
    ::testing::Values(RandomWaters{"munk", munk_knots(), {{0, 5000}}, false, 1000, 100'000, 5, 1500},
                      RandomWaters{"summer", kSummer, {{0, 200}}, false, 100, 10'000, 10, 2500},
                      RandomWaters{"ducts", kDucts, {{0, 300}}, false, 100, 15'000, 9, 2500},
                      RandomWaters{"seamount25", kSeamountWater, gaussian(25, 600), true, 200, 5500, 5, 1500},
                      RandomWaters{"seamount50", kSeamountWater, gaussian(50, 400), true, 200, 5500, 5, 1500},
                      RandomWaters{"seamount100", kSummer, gaussian(100, 600), true, 200, 5500, 5, 1500}),
    [](const auto& waters) { return std::string(waters.param.name); });

}  // namespace
}  // namespace halocline::acoustics
