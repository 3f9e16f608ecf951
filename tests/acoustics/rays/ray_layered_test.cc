// SPDX-License-Identifier: BSD-3-Clause
// Rays in water that depends on depth alone: closed forms, symmetries.
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
#include "tests/support/csv.h"

namespace halocline::acoustics {
namespace {

using testing::CsvRow;
using testing::tolerance;

// ---------------------------------------------------------------------------------------------- closed forms

// Water of constant gradient as deep as speeds stay believable.
double depth_of_gradient(double g) { return std::min(4000.0, 400 / std::abs(g)); }

TEST(LayeredRays, DirectRayInAConstantGradientIsTheClosedForm) {
  int compared = 0;
  for (const CsvRow& row : testing::read_reference_csv("acoustics/eigenray_linear_gradient.csv")) {
    const double c0 = row.number("c_surface_m_per_s"), g = row.number("gradient_per_s");
    const double bottom = depth_of_gradient(g), range = row.number("range_m");
    const double tx = row.number("depth_tx_m"), rx = row.number("depth_rx_m");
    // Where the closed form's arc (about a parabola of sag g r^2 / 8 c below the chord) leaves the water
    // there is no such ray.
    const double sag = g * range * range / (8 * c0), quarter = 0.75 * tx + 0.25 * rx + 0.75 * sag;
    const double three_quarters = 0.25 * tx + 0.75 * rx + 0.75 * sag, half = 0.5 * (tx + rx) + sag;
    if (std::min({quarter, half, three_quarters}) < 0) continue;
    const RaySea sea = sea_of({{0, c0}, {bottom, c0 + bottom * g}}, BottomProfile::flat(bottom));
    for (const RaySolver solver : {RaySolver::kSnell, RaySolver::kArcs}) {
      double off = 1, length_off = 1;
      for (const Eigenray& path : eigenrays(sea, {tx, rx, range}, solver).paths) {
        if (path.surface_bounces + path.bottom_bounces > 0) continue;
        off = std::min(off, std::abs(path.delay_s - row.number("travel_time_s")));
        length_off = std::min(length_off, std::abs(path.path_length_m - row.number("arc_length_m")));
      }
      // Ends at the surface are moved by a micrometre, which is 7e-10 s at most.
      EXPECT_LT(off, tolerance(1e-9)) << "line " << row.line() << " by " << to_name(solver);
      EXPECT_LT(length_off, tolerance(1e-5)) << "line " << row.line() << " by " << to_name(solver);
    }
    ++compared;
  }
  EXPECT_GE(compared, 4);
}

TEST(LayeredRays, FirstEchoesAreThoseOfTheImageMethod) {
  for (const CsvRow& row : testing::read_reference_csv("acoustics/image_method_delays.csv")) {
    const RaySea sea =
        sea_of({{0, row.number("c_m_per_s")}}, BottomProfile::flat(row.number("water_depth_m")));
    RaySea open = sea;
    open.options.max_launch_angle_rad = std::numbers::pi / 2;
    open.options.min_boundary_factor = 0;
    open.options.max_bounces = 2;
    for (const RaySolver solver : {RaySolver::kImages, RaySolver::kSnell, RaySolver::kArcs}) {
      // Arcs stop at 89.9 degrees from the horizontal.
      if (solver == RaySolver::kArcs && row.number("range_m") < 0.05 * row.number("water_depth_m")) continue;
      const Eigenrays found = eigenrays(
          open, {row.number("depth_tx_m"), row.number("depth_rx_m"), row.number("range_m")}, solver);
      for (const char* leg :
           {"t_direct_s", "t_surface_s", "t_bottom_s", "t_surface_bottom_s", "t_bottom_surface_s"}) {
        const bool is_found = std::any_of(found.paths.begin(), found.paths.end(), [&](const Eigenray& path) {
          return std::abs(path.delay_s - row.number(leg)) < tolerance(1e-10);
        });
        EXPECT_TRUE(is_found) << "line " << row.line() << " " << leg << " by " << to_name(solver);
      }
    }
  }
}

TEST(LayeredRays, AnglesKeepSnellsInvariant) {
  const RaySea sea = sea_of(kSummer, BottomProfile::flat(120));
  for (const Eigenray& path : eigenrays(sea, {15, 90, 3000}).paths) {
    EXPECT_NEAR(std::cos(path.launch_angle_rad) / sea.water.speed_at(15),
                std::cos(path.arrival_angle_rad) / sea.water.speed_at(90), tolerance(1e-18));
  }
}

TEST(LayeredRays, AmplitudeIsTheWidthOfTheRayTubeByDifferences) {
  // |dr/dtheta| from two receivers a little apart: the same ray family, ranges +-h.
  const RaySea sea = sea_of(kThermocline, BottomProfile::flat(100));
  constexpr double kStep = 0.5;  // m
  const Eigenrays here = eigenrays(sea, {20, 80, 2000}), near = eigenrays(sea, {20, 80, 2000 - kStep}),
                  far = eigenrays(sea, {20, 80, 2000 + kStep});
  int compared = 0;
  for (const Eigenray& path : here.paths) {
    const auto same = [&path](const Eigenray& other) { return other.identity == path.identity; };
    const auto a = std::find_if(near.paths.begin(), near.paths.end(), same);
    const auto b = std::find_if(far.paths.begin(), far.paths.end(), same);
    if (a == near.paths.end() || b == far.paths.end()) continue;
    const double slope = 2 * kStep / std::abs(b->launch_angle_rad - a->launch_angle_rad);
    const double tube = 2000 * slope * std::abs(std::sin(path.arrival_angle_rad));
    const double spread =
        std::sqrt(sea.water.speed_at(80) * std::cos(path.launch_angle_rad) / (sea.water.speed_at(20) * tube));
    const double bounces = std::pow(10.0, -path.bottom_loss_db / 20);
    EXPECT_NEAR(20 * std::log10(path.amplitude / (spread * bounces)), 0, tolerance(0.01)) << describe(path);
    ++compared;
  }
  EXPECT_GT(compared, 15);
}

// ---------------------------------------------------------------------------------------------- symmetries

class RayReciprocity : public ::testing::TestWithParam<RaySolver> {};

TEST_P(RayReciprocity, SwappedEndsHaveTheSameDelaysAndAmplitudes) {
  for (const auto& [knots, depth] :
       {std::pair(kSummer, 120.0), std::pair(kDucts, 200.0), std::pair(kThermocline, 100.0)}) {
    const RaySea sea = sea_of(knots, BottomProfile::flat(depth));
    for (const RayLink link :
         {RayLink{15, 90, 700}, RayLink{40, 55, 2500}, RayLink{30, 31, 4000}, RayLink{5, 99, 50}}) {
      const Eigenrays there = eigenrays(sea, link, GetParam());
      const Eigenrays back =
          eigenrays(sea, {link.receiver_depth_m, link.source_depth_m, link.range_m}, GetParam());
      ASSERT_EQ(there.paths.size(), back.paths.size()) << link.range_m;
      for (std::size_t i = 0; i < there.paths.size(); ++i) {
        const Eigenray &a = there.paths[i], &b = back.paths[i];
        EXPECT_NEAR(a.delay_s, b.delay_s, tolerance(1e-10)) << describe(a);
        EXPECT_NEAR(20 * std::log10(a.amplitude / b.amplitude), 0, tolerance(1e-3))
            << describe(a) << describe(b);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Solvers, RayReciprocity, ::testing::Values(RaySolver::kSnell, RaySolver::kArcs));

TEST(LayeredRays, SumOfImagesAndSnellSolverAgreeInWaterOfOneSpeed) {
  const RaySea sea = sea_of({{0, 1487}}, BottomProfile::flat(73), [](double z) { return 3 + z / 50; });
  for (const RayLink link :
       {RayLink{10, 60, 5}, RayLink{10, 60, 800}, RayLink{36.5, 36.5, 1500}, RayLink{1, 72, 6000}}) {
    const Eigenrays images = eigenrays(sea, link, RaySolver::kImages),
                    snell = eigenrays(sea, link, RaySolver::kSnell);
    ASSERT_EQ(images.paths.size(), snell.paths.size()) << link.range_m;
    for (std::size_t i = 0; i < images.paths.size(); ++i) {
      const Eigenray& a = images.paths[i];
      std::vector<bool> used(snell.paths.size());
      const int j = find_path(snell.paths, used, a.delay_s, a.launch_angle_rad, a.surface_bounces,
                              a.bottom_bounces, 1e-12);
      ASSERT_GE(j, 0) << describe(a);
      const Eigenray& b = snell.paths[static_cast<std::size_t>(j)];
      EXPECT_NEAR(a.amplitude / b.amplitude, 1, tolerance(1e-6)) << describe(a);
      EXPECT_NEAR(a.absorption_db, b.absorption_db, tolerance(1e-5)) << describe(a);
      EXPECT_LE(degrees_between(to_degrees(a.phase_rad), to_degrees(b.phase_rad)), tolerance(1e-3))
          << describe(a);
    }
  }
}

TEST(LayeredRays, AbsorptionIsTheIntegralAlongTheArc) {
  // alpha = 2 dB/km + 0.1 dB/km per m of depth, down a straight vertical path of 80 m: mean at the middle.
  RaySea sea = sea_of(kThermocline, BottomProfile::flat(100), [](double z) { return 2 + 0.1 * z; });
  sea.options.max_launch_angle_rad = 1.57;
  sea.options.keep_steep_direct = true;
  const Eigenrays found = eigenrays(sea, {10, 90, 1e-3}, RaySolver::kSnell);
  ASSERT_FALSE(found.shadow());
  EXPECT_NEAR(found.paths.front().absorption_db, 80e-3 * (2 + 0.1 * 50), tolerance(1e-9));
}

// ---------------------------------------------------------------------------------------------- where it
// gets hard

TEST(LayeredRays, VerticalLinkHasItsDirectPathAtEveryRange) {
  const RaySea sea = sea_of(kSummer, BottomProfile::flat(120));
  for (const double range : {0.0, 1e-6, 0.01, 1.0, 10.0}) {
    for (const RaySolver solver : {RaySolver::kSnell, RaySolver::kArcs}) {
      const Eigenrays found = eigenrays(sea, {5, 110, range}, solver);
      EXPECT_TRUE(has_direct_path(found)) << range << " by " << to_name(solver);
    }
  }
}

TEST(LayeredRays, NoPathIsSteeperThanTheLimitUnlessSteepOnesAreKept) {
  for (const auto& knots : {kSummer, std::vector<SpeedRow>{{0, 1500}}}) {
    RaySea sea = sea_of(knots, BottomProfile::flat(120));
    sea.options.keep_steep_direct = false;
    for (const RaySolver solver : {RaySolver::kImages, RaySolver::kSnell, RaySolver::kArcs}) {
      if (solver == RaySolver::kImages && knots.size() > 1) continue;
      const Eigenrays found = eigenrays(sea, {5, 110, 10}, solver);  // the direct path leaves at 84.6 degrees
      EXPECT_FALSE(has_direct_path(found)) << to_name(solver);
      for (const Eigenray& path : found.paths) EXPECT_LE(std::abs(path.launch_angle_rad), to_radians(80));
    }
  }
}

TEST(LayeredRays, EndsOfOneDepthInALayerOfOneSpeedHaveAStraightHorizontalRay) {
  const RaySea sea = sea_of(kThermocline, BottomProfile::flat(100));
  for (const double depth : {50.0, 75.0, 99.0}) {
    const Eigenrays found = eigenrays(sea, {depth, depth, 1200});
    const auto straight = std::find_if(found.paths.begin(), found.paths.end(),
                                       [](const Eigenray& path) { return path.launch_angle_rad == 0; });
    ASSERT_NE(straight, found.paths.end()) << depth;
    EXPECT_NEAR(straight->delay_s, 1200 / 1490.0, tolerance(1e-12));
    EXPECT_NEAR(straight->amplitude, 1 / 1200.0, tolerance(1e-12));
  }
}

TEST(LayeredRays, NearlyLevelRaysInALayerOfOneSpeedAreFound) {
  const RaySea sea = sea_of(kThermocline, BottomProfile::flat(100));
  for (const double step : {1e-6, 1e-4, 1e-2, 1.0}) {
    const Eigenrays found = eigenrays(sea, {70, 70 + step, 3000});
    double best = 1;
    for (const Eigenray& path : found.paths) {
      best = std::min(best, std::abs(path.delay_s - std::hypot(3000, step) / 1490));
    }
    EXPECT_LT(best, tolerance(1e-10)) << step;
  }
}

TEST(LayeredRays, EndsAtTheBoundariesHaveRaysOfFiniteAmplitude) {
  const RaySea sea = sea_of(kThermocline, BottomProfile::flat(100));
  for (const RayLink link :
       {RayLink{0, 50, 500}, RayLink{50, 100, 500}, RayLink{0, 100, 500}, RayLink{0, 0, 500}}) {
    for (const RaySolver solver : {RaySolver::kSnell, RaySolver::kArcs}) {
      const Eigenrays found = eigenrays(sea, link, solver);
      EXPECT_FALSE(found.shadow());
      for (const Eigenray& path : found.paths) EXPECT_TRUE(std::isfinite(path.amplitude)) << describe(path);
    }
  }
}

TEST(LayeredRays, AShadowHasNoDirectPathAndAnAbsorbingBottomLeavesNone) {
  // Speed falls with depth: the direct ray bends away, beyond its last graze of the surface there is none.
  RaySea sea = sea_of({{0, 1520}, {100, 1490}}, BottomProfile::flat(100));
  EXPECT_FALSE(has_direct_path(eigenrays(sea, {10, 10, 2000})));
  EXPECT_FALSE(eigenrays(sea, {10, 10, 2000}).shadow());
  sea.bottom = FluidBottom{1, 1, 0, 0, BottomLoss::kComplexWaveNumber};  // more water: no echo
  EXPECT_TRUE(eigenrays(sea, {10, 10, 2000}).shadow());
}

TEST(LayeredRays, FoldsHaveFiniteLevels) {
  // Walk the receiver over the edge of a caustic in centimetres: without a bound the level runs away there.
  RaySea sea = sea_of(kSummer, BottomProfile::flat(120));
  sea.options.airy_folds = true;
  double loudest = 0;
  for (double range = 900; range < 1500; range += 0.5) {
    for (const Eigenray& path : eigenrays(sea, {40, 60, range}).paths)
      loudest = std::max(loudest, path.amplitude);
  }
  EXPECT_LT(loudest, 0.1);  // 20 dB above a free field at 100 m, at ten times the range
}

TEST(LayeredRays, OptionsLimitBouncesAndAmplitude) {
  RaySea sea = sea_of(kThermocline, BottomProfile::flat(100));
  const std::size_t all = eigenrays(sea, {20, 80, 2000}).paths.size();
  sea.options.max_bounces = 3;
  for (const Eigenray& path : eigenrays(sea, {20, 80, 2000}).paths) {
    EXPECT_LE(path.surface_bounces + path.bottom_bounces, 3);
  }
  sea.options.max_bounces = 400;
  sea.options.min_amplitude = 1e-4;
  const Eigenrays loud = eigenrays(sea, {20, 80, 2000});
  EXPECT_LT(loud.paths.size(), all);
  for (const Eigenray& path : loud.paths) EXPECT_GE(path.amplitude, 1e-4);
}

TEST(LayeredRays, RefusesWhatItWouldGetWrong) {
  const RaySea slope = sea_of({{0, 1500}}, BottomProfile({{0, 100}, {1000, 50}}));
  EXPECT_THROW(eigenrays(slope, {10, 10, 500}, RaySolver::kSnell), InvalidArgument);
  EXPECT_THROW(eigenrays(slope, {10, 90, 900}), InvalidArgument);  // under the bottom
  const RaySea layered = sea_of(kThermocline, BottomProfile::flat(100));
  EXPECT_THROW(eigenrays(layered, {10, 10, 500}, RaySolver::kImages), InvalidArgument);
}

}  // namespace
}  // namespace halocline::acoustics
