// SPDX-License-Identifier: BSD-3-Clause
// Eigenrays extrapolated from one link to another near by, against those that are searched for there.
#include "acoustics/rays/extrapolate_eigenrays.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/ray_water.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/random.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using halocline::testing::tolerance;

double no_absorption(double) { return 0; }

RaySea sea_of(const std::vector<SpeedRow>& knots, BottomProfile bottom) {
  return {RayWater(knots, no_absorption), std::move(bottom), fluid_bottom(1.9, 1650, 0.8),
          RaySurface{SurfaceModel::kFlat, 0}, RayOptions{}};
}

RaySea even_sea() { return sea_of({{0, 1500}}, BottomProfile::flat(100)); }
RaySea layered_sea() { return sea_of({{0, 1520}, {50, 1490}, {100, 1492}}, BottomProfile::flat(100)); }

std::vector<Eigenray> extrapolate(const RaySea& sea, const RayLink& from, const RayLink& to) {
  const EndSpeeds speeds{sea.water.speed_at(from.source_depth_m), sea.water.speed_at(from.receiver_depth_m)};
  return extrapolate_eigenrays(eigenrays(sea, from).paths, from, speeds, to);
}

// The path of `all` that is `path`; null where there is none.
const Eigenray* same_in(const std::vector<Eigenray>& all, const Eigenray& path) {
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const Eigenray& other) { return other.identity == path.identity; });
  return found == all.end() ? nullptr : &*found;
}

TEST(ExtrapolateEigenrays, IsExactInWaterOfOneSpeedOverALevelBottom) {
  const RaySea sea = even_sea();
  const RayLink from{30, 55, 800}, to{37, 49, 861};
  const auto searched = eigenrays(sea, to).paths, extrapolated = extrapolate(sea, from, to);
  int compared = 0;
  for (const Eigenray& path : extrapolated) {
    const Eigenray* exact = same_in(searched, path);
    if (exact == nullptr) continue;  // its bounces take a little more or less than the limit
    ++compared;
    EXPECT_NEAR(path.delay_s, exact->delay_s, tolerance(1e-12));
    EXPECT_NEAR(path.path_length_m, exact->path_length_m, tolerance(1e-9));
    EXPECT_NEAR(path.launch_angle_rad, exact->launch_angle_rad, tolerance(1e-12));
    EXPECT_NEAR(path.arrival_angle_rad, exact->arrival_angle_rad, tolerance(1e-12));
    if (path.bottom_bounces == 0) {
      EXPECT_NEAR(path.amplitude / exact->amplitude, 1, tolerance(1e-9));
    }
  }
  EXPECT_GT(compared, 15);
}

TEST(ExtrapolateEigenrays, TheReverseLinkIsExtrapolatedAlike) {
  const RaySea sea = layered_sea();
  const RayLink from{30, 55, 800}, to{33, 52, 830};
  const auto there = extrapolate(sea, from, to),
             back = extrapolate(sea, {from.receiver_depth_m, from.source_depth_m, from.range_m},
                                {to.receiver_depth_m, to.source_depth_m, to.range_m});
  ASSERT_EQ(there.size(), back.size());
  for (std::size_t i = 0; i < there.size(); ++i) {
    EXPECT_NEAR(there[i].delay_s, back[i].delay_s, tolerance(1e-9)) << i;
  }
}

// Greatest error of a delay among paths away from folds, over random displacements of at most `size_m` in
// range and a tenth of that in depth.
double worst_delay_s(const RaySea& sea, double size_m) {
  const auto draw = [](std::uint32_t who, std::uint64_t which) {
    return uniform_at({.seed = 3, .purpose = purpose_of("carry"), .who = who, .which = which});
  };
  double worst = 0;
  for (std::uint32_t i = 0; i < 20; ++i) {
    const RayLink from{20 + 20 * draw(i, 0), 60 + 20 * draw(i, 1), 600 + 600 * draw(i, 2)};
    const RayLink to{from.source_depth_m + 0.1 * size_m * (2 * draw(i, 3) - 1),
                     from.receiver_depth_m + 0.1 * size_m * (2 * draw(i, 4) - 1),
                     from.range_m + size_m * (2 * draw(i, 5) - 1)};
    const auto searched = eigenrays(sea, to).paths;
    for (const Eigenray& path : extrapolate(sea, from, to)) {
      if (path.caustics > 0 || path.surface_bounces + path.bottom_bounces > 3) continue;
      if (const Eigenray* exact = same_in(searched, path)) {
        worst = std::max(worst, std::abs(path.delay_s - exact->delay_s));
      }
    }
  }
  return worst;
}

// Half the displacement, a quarter of the error: 2 bits of it, 1.6 with what third powers leave.
void expect_second_order(const RaySea& sea) {
  const double whole = worst_delay_s(sea, 16), half = worst_delay_s(sea, 8), quarter = worst_delay_s(sea, 4);
  EXPECT_GT(whole, 1e-9);  // there is something to measure
  EXPECT_GT(std::log2(whole / half), 1.6);
  EXPECT_GT(std::log2(half / quarter), 1.6);
}

TEST(ExtrapolateEigenrays, DelaysErrByTheSquareOfTheDisplacementInLayeredWater) {
  expect_second_order(layered_sea());
}

// The bottom stretches with the range, as the channel server's profiles do: a straight slope of 20 m.
TEST(ExtrapolateEigenrays, DelaysErrByTheSquareOfTheDisplacementOverASlopeThatStretchesAlong) {
  const auto sloping = [](double range_m) {
    return sea_of({{0, 1520}, {50, 1490}, {200, 1492}}, BottomProfile({{0, 120}, {range_m, 100}}, 0));
  };
  const auto worst = [&](double size_m) {
    const RayLink from{30, 60, 900}, to{30 + 0.05 * size_m, 60 - 0.04 * size_m, 900 + size_m};
    const RaySea sea = sloping(from.range_m);
    const auto searched = eigenrays(sloping(to.range_m), to).paths;
    double error = 0;
    int compared = 0;
    for (const Eigenray& path : extrapolate(sea, from, to)) {
      const Eigenray* exact = same_in(searched, path);
      if (exact == nullptr || path.caustics > 0) continue;
      ++compared;
      error = std::max(error, std::abs(path.delay_s - exact->delay_s));
    }
    EXPECT_GT(compared, 5);
    return error;
  };
  const double whole = worst(16), half = worst(8), quarter = worst(4);
  EXPECT_GT(whole, 1e-9);
  EXPECT_GT(std::log2(whole / half), 1.6);
  EXPECT_GT(std::log2(half / quarter), 1.6);
}

TEST(ExtrapolateEigenrays, PathsAreInTheOrderOfTheirDelays) {
  const auto paths = extrapolate(layered_sea(), {30, 55, 800}, {31, 58, 700});
  ASSERT_GT(paths.size(), 5u);
  EXPECT_TRUE(std::is_sorted(paths.begin(), paths.end(),
                             [](const Eigenray& a, const Eigenray& b) { return a.delay_s < b.delay_s; }));
}

}  // namespace
}  // namespace halocline::acoustics
