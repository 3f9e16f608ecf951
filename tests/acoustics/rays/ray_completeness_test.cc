// SPDX-License-Identifier: BSD-3-Clause
// Rays in water that depends on depth alone: no ray of a dense fan is missing.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/layered_rays.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/check.h"
#include "core/random.h"
#include "tests/acoustics/rays/dense_fan.h"
#include "tests/acoustics/rays/layered_waters.h"
#include "tests/acoustics/rays/ray_reference.h"

namespace halocline::acoustics {
namespace {

using testing::tolerance;

struct Waters {
  const char* name;
  std::vector<SpeedRow> knots;
  double bottom_m, farthest_m;
  RaySolver solver;
  int links, fan;
};

class RayCompleteness : public ::testing::TestWithParam<Waters> {};

RayLink random_link(const Waters& waters, std::uint32_t index) {
  const auto draw = [&](std::uint64_t which) {
    return uniform_at({.seed = 3, .purpose = purpose_of("links"), .who = index, .which = which});
  };
  const auto depth = [&](std::uint64_t which) { return (0.01 + 0.98 * draw(which)) * waters.bottom_m; };
  RayLink link{depth(1), depth(2), 10 * std::pow(waters.farthest_m / 10, draw(3))};
  const auto knot = [&](std::uint64_t which) {
    const auto inner = static_cast<double>(waters.knots.size() - 2);
    return waters.knots[1 + static_cast<std::size_t>(draw(which) * inner)].depth_m;
  };
  if (index % 5 == 1) link.receiver_depth_m = link.source_depth_m;
  if (index % 5 == 2) link.source_depth_m = knot(4);
  if (index % 7 == 3) link.receiver_depth_m = knot(5);
  return link;
}

// The fan may lack a faint pair but invents nothing: every ray of it has to be there. What is there beyond it
// has to be faint, or horizontal (which a fan that turns in the water does not see).
TEST_P(RayCompleteness, NoRayOfADenseFanIsMissing) {
  const Waters& waters = GetParam();
  const RaySea sea = sea_of(waters.knots, BottomProfile::flat(waters.bottom_m));
  const double bottom_speed = sea.water.speed_at(waters.bottom_m);
  for (int i = 0; i < waters.links; ++i) {
    const RayLink link = random_link(waters, static_cast<std::uint32_t>(i));
    const Eigenrays found = eigenrays(sea, link, waters.solver);
    int max_bounces = 0;
    double loudest = 0;
    for (const Eigenray& path : found.paths) {
      max_bounces = std::max(max_bounces, path.bottom_bounces);
      loudest = std::max(loudest, path.amplitude);
    }
    std::vector<bool> used(found.paths.size());
    DenseFan fan(waters.knots, waters.bottom_m, link);
    for (const FanEigenray& ray : fan.search(to_radians(80), max_bounces, waters.fan)) {
      const double cosine =
          std::cos(ray.launch_angle_rad) / sea.water.speed_at(link.source_depth_m) * bottom_speed;
      const double one =
          cosine < 1 ? bottom_magnitude_at_sine(sea.bottom, std::sqrt(1 - cosine * cosine), bottom_speed) : 1;
      if (std::pow(one, ray.bottom_bounces) < 0.005 * 1.001) continue;
      const int index = find_path(found.paths, used, ray.delay_s, ray.launch_angle_rad, ray.surface_bounces,
                                  ray.bottom_bounces, tolerance(1e-7));
      EXPECT_GE(index, 0) << waters.name << " " << link.source_depth_m << " " << link.receiver_depth_m << " "
                          << link.range_m << ": missing " << ray.delay_s << " s at "
                          << to_degrees(ray.launch_angle_rad) << " deg";
      if (index >= 0) used[static_cast<std::size_t>(index)] = true;
    }
    for (std::size_t k = 0; k < used.size(); ++k) {
      const Eigenray& path = found.paths[k];
      const bool seen =
          used[k] || path.launch_angle_rad == 0 || std::abs(path.launch_angle_rad) > to_radians(79.9);
      EXPECT_TRUE(seen || path.amplitude < 0.03 * loudest)
          << waters.name << " " << link.source_depth_m << " " << link.receiver_depth_m << " " << link.range_m
          << ": extra " << describe(path);
    }
  }
}

std::string waters_name(const ::testing::TestParamInfo<Waters>& info) {
  return std::string(info.param.name) + "_" + std::string(to_name(info.param.solver));
}

// Numbers of links and rays keep each case below some seconds of a debug build.
INSTANTIATE_TEST_SUITE_P(
    Waters, RayCompleteness,
    ::testing::Values(Waters{"thermocline", kThermocline, 100, 6000, RaySolver::kSnell, 20, 1500},
                      Waters{"summer", kSummer, 120, 5000, RaySolver::kSnell, 10, 1000},
                      Waters{"ducts", kDucts, 200, 8000, RaySolver::kSnell, 10, 1000},
                      Waters{"munk", munk_knots(), 5000, 60000, RaySolver::kSnell, 4, 1000},
                      Waters{"thermocline", kThermocline, 100, 4000, RaySolver::kArcs, 8, 1000},
                      Waters{"summer", kSummer, 120, 3000, RaySolver::kArcs, 4, 800}),
    waters_name);

}  // namespace
}  // namespace halocline::acoustics
