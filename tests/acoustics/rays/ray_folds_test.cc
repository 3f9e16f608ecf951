// SPDX-License-Identifier: BSD-3-Clause
// The field about folds of rays, on both sides of the caustic, against what follows from rays away from it.
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

#include <boost/math/special_functions/airy.hpp>
#include <gtest/gtest.h>

#include "acoustics/math/fold_field.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/sea/bottom_profile.h"
#include "tests/acoustics/rays/ray_reference.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

constexpr double kFrequency = 25'000;

double decibels(double ratio) { return 20 * std::log10(ratio); }

// A caustic of two rays that leave the source all but horizontally: by bottom alone, launched within 2
// degrees. Lit where the source is deeper.
struct Column {
  std::vector<SpeedRow> rows = {{0, 1530}, {15, 1530.4}, {30, 1510.7}, {50, 1504.6}, {100, 1505.5}};
  BottomProfile bottom = BottomProfile::flat(100);
};

std::vector<Eigenray> near_caustic(double source_m, RaySolver solver, bool airy) {
  const Column column;
  RaySea sea = sea_of(column.rows, column.bottom);
  sea.options.airy_folds = airy;
  std::vector<Eigenray> paths;
  for (const Eigenray& path : eigenrays(sea, {source_m, 78, 1900}, solver).paths) {
    const bool is_near = path.surface_bounces == 0 && path.bottom_bounces == 1 &&
                         std::abs(path.launch_angle_rad) < to_radians(2);
    if (is_near) paths.push_back(path);
  }
  return paths;
}

std::complex<double> sum_of(const std::vector<Eigenray>& paths) {
  std::complex<double> sum = 0;
  for (const Eigenray& path : paths)
    sum += std::polar(path.amplitude, path.phase_rad - 2 * pi * std::fmod(kFrequency * path.delay_s, 1.0));
  return sum;
}

double power_of(const std::vector<Eigenray>& paths) {
  double power = 0;
  for (const Eigenray& path : paths) power += path.amplitude * path.amplitude;
  return power;
}

TEST(FoldField, ItsSharesAreThoseOfAirysFunctions) {
  for (double x = 0.01; x < kLitFold; x += 0.07) {
    const FoldShare share = fold_share(x);
    const double ray = std::pow(x, -0.25) / (2 * std::sqrt(pi)), phase = 2.0 / 3 * std::pow(x, 1.5) - pi / 4;
    EXPECT_NEAR(2 * ray * share.factor * std::cos(phase + share.phase_rad), boost::math::airy_ai(-x), 1e-10);
    EXPECT_NEAR(2 * ray * share.factor * std::sin(phase + share.phase_rad), -boost::math::airy_bi(-x), 1e-10);
  }
  EXPECT_NEAR(boost::math::airy_ai(-kMergedFold), boost::math::airy_bi(-kMergedFold), 0.01);
  EXPECT_NEAR(fold_share(kLitFold).factor, 1, 2e-3);
  EXPECT_NEAR(decibels(boost::math::airy_ai(-kDarkFold) / 0.5357), -31, 0.5);
}

TEST(FoldField, ASingleRaysTubeGivesAirysLevel) {
  const Fold fold{1e5, 5e-4};
  const double length = fold.length_m(kFrequency);
  // Two rays at the distance x L have |du| = sqrt(2 x L |d2u|), omega dt = (2/3) omega |dp| |d2u| (2 x L /
  // |d2u|)^(3/2).
  for (const double x : {0.5, 1.0, 3.0}) {
    const double time_s =
        2.0 / 3 * fold.slowness_slope * fold.curvature * std::pow(2 * x * length / fold.curvature, 1.5);
    EXPECT_NEAR(fold_place(time_s, kFrequency), x, 1e-9);
    // C Ai(0) over the amplitude of a ray: both go with the root of their tubes.
    const double tube = std::sqrt(2 * x * length * fold.curvature);
    EXPECT_NEAR(std::sqrt(tube / fold.tube_slope(0, kFrequency)),
                2 * std::sqrt(pi) * std::pow(x, 0.25) * boost::math::airy_ai(0.0), 1e-9);
  }
}

class Folds : public ::testing::TestWithParam<RaySolver> {};

// Two rays at one place, no ray at another: from the amplitudes and the delays of the two follow where the
// caustic is and how the field decays beyond it.
TEST_P(Folds, TheDarkSideFollowsFromTheRaysOfTheLitSide) {
  const std::vector<Eigenray> lit = near_caustic(43.6, GetParam(), false);
  ASSERT_EQ(lit.size(), 2U);
  const double x_lit = fold_place(std::abs(lit[1].delay_s - lit[0].delay_s), kFrequency);
  const std::vector<Eigenray> nearer = near_caustic(43.5, GetParam(), false);
  ASSERT_EQ(nearer.size(), 2U);
  const double length_m =
      0.1 / (x_lit - fold_place(std::abs(nearer[1].delay_s - nearer[0].delay_s), kFrequency));
  const double amplitude = 2 * std::sqrt(pi) * std::pow(x_lit, 0.25) * std::sqrt(power_of(lit) / 2);
  for (const double depth : {43.3, 43.1, 42.9}) {
    EXPECT_TRUE(near_caustic(depth, GetParam(), false).empty());
    const std::vector<Eigenray> dark = near_caustic(depth, GetParam(), true);
    ASSERT_EQ(dark.size(), 1U) << depth;
    const double x = x_lit - (43.6 - depth) / length_m;
    EXPECT_NEAR(decibels(dark[0].amplitude / (amplitude * boost::math::airy_ai(-x))), 0, 0.5) << depth;
  }
  EXPECT_TRUE(near_caustic(41.5, GetParam(), true).empty());  // too far in the dark
}

TEST_P(Folds, LevelsHaveNoStepAcrossTheCaustic) {
  double last_coherent = 0, last_power = 0;
  for (int i = 0; i <= 150; ++i) {  // 0.8 m in the dark to 0.7 m in the light
    const std::vector<Eigenray> paths = near_caustic(42.6 + 0.01 * i, GetParam(), true);
    ASSERT_FALSE(paths.empty()) << i;
    const double coherent = decibels(std::abs(sum_of(paths))), power = 10 * std::log10(power_of(paths));
    if (i > 0) {
      EXPECT_NEAR(coherent, last_coherent, 0.4) << i;
      EXPECT_NEAR(power, last_power, 0.4) << i;
    }
    last_coherent = coherent;
    last_power = power;
  }
}

INSTANTIATE_TEST_SUITE_P(Solvers, Folds, ::testing::Values(RaySolver::kSnell, RaySolver::kArcs),
                         [](const auto& solver) { return std::string(to_name(solver.param)); });

// One solver knows delays and d range/d xi, the other how depth bends over launch angle.
TEST(Folds, BothSolversAgree) {
  for (int i = 0; i <= 13; ++i) {
    const double depth = 42.9 + 0.1 * i;
    const auto snell = sum_of(near_caustic(depth, RaySolver::kSnell, true)),
               arcs = sum_of(near_caustic(depth, RaySolver::kArcs, true));
    EXPECT_NEAR(decibels(std::abs(snell) / std::abs(arcs)), 0, 0.5) << depth;
    EXPECT_LT(std::abs(std::arg(snell / arcs)), 0.1) << depth;
  }
}

TEST(Folds, WithoutWavesTheDarkSideIsSilentAndRaysAreTheirOwn) {
  const std::vector<Eigenray> rays = near_caustic(45, RaySolver::kSnell, false),
                              waves = near_caustic(45, RaySolver::kSnell, true);
  ASSERT_EQ(rays.size(), waves.size());  // 20 lengths of Airy away
  for (std::size_t i = 0; i < rays.size(); ++i) EXPECT_NEAR(rays[i].amplitude / waves[i].amplitude, 1, 1e-2);
}

}  // namespace
}  // namespace halocline::acoustics
