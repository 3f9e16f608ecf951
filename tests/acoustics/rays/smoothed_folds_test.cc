// SPDX-License-Identifier: BSD-3-Clause
// Folds, cusps and turning rays in a medium that is not perfect, against the integral over launch angles and
// the power that a smoothed family must keep.
#include "acoustics/rays/search/smoothed_folds.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/search/cycle_rays.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/sea/fine_structure.h"
#include "tests/acoustics/rays/ray_reference.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;
using testing::tolerance;

constexpr FineStructure kUsual{.speed_mps = 0.05, .internal_wave_m = 0.5};
constexpr double kFrequency = 25'000;

double decibels(double power) { return 10 * std::log10(power); }

RaySea smoothed_sea(const std::vector<SpeedRow>& rows, double depth_m, const FineStructure& structure) {
  RaySea sea = sea_of(rows, BottomProfile::flat(depth_m));
  sea.options.frequency_hz = kFrequency;
  sea.options.airy_folds = true;
  sea.options.fine_structure = structure;
  return sea;
}

double power_of(const std::vector<Eigenray>& paths) {
  double power = 0;
  for (const Eigenray& path : paths) power += path.amplitude * path.amplitude;
  return power;
}

// The cusp of rays by one bounce of rock, from 60 m to 60 m.
const std::vector<SpeedRow> kCuspRows{{0, 1520}, {100, 1510}};
const std::vector<SpeedRow> kSummer{{0, 1527}, {15, 1527}, {30, 1506}, {50, 1500}, {100, 1501}};

std::vector<Eigenray> cusp_family(double range_m, const FineStructure& structure) {
  RaySea sea = smoothed_sea(kCuspRows, 100, structure);
  sea.bottom = *sediment("Rock");
  std::vector<Eigenray> family;
  for (const Eigenray& path : eigenrays(sea, {60, 60, range_m}).paths) {
    if (path.surface_bounces == 0 && path.bottom_bounces == 1) family.push_back(path);
  }
  return family;
}

// Level of that family by the integral over launch angles of parabolic rays 40 m above the bottom:
//   x1 = (t_b - t) / k, y = t_b (r - x1) - k (r - x1)^2 / 2,  t_b^2 = t^2 + 80 m k,  k = g / c.
double cusp_level_db(double range_m, double sigma_m) {
  constexpr double kCurvature = 0.1 / 1514, kHeight = 40, kStep = 1e-6;
  double sum = 0;
  for (double t = -0.25; t < 0.25; t += kStep) {
    const double at_bottom = std::sqrt(t * t + 2 * kCurvature * kHeight);
    const double s = range_m - (at_bottom - t) / kCurvature;
    if (!(s > 0 && s < 2 * at_bottom / kCurvature)) continue;
    const double off = at_bottom * s - kCurvature / 2 * s * s - kHeight;
    sum += std::exp(-off * off / (2 * sigma_m * sigma_m));
  }
  return decibels(sum * kStep / (std::sqrt(2 * pi) * sigma_m * range_m));
}

TEST(SmoothedFolds, ACuspHasTheLevelOfTheIntegralOverLaunchAngles) {
  const RayWater water(kCuspRows, no_absorption);
  for (const double range : {2197.0, 2202.0, 2300.0}) {
    const double mu = cycle_turning_rate(water, kUsual, 100, 60, 1 / 1514.0);
    const double sigma = std::sqrt(mu * std::pow(range, 3) / 3);
    EXPECT_NEAR(decibels(power_of(cusp_family(range, kUsual))), cusp_level_db(range, sigma), tolerance(0.4))
        << range;
  }
}

// Ends at one depth of a shallow sea whose speed falls by 0.6 m/s down to the bottom: the rays of few bounces
// that are launched within a thousandth of a radian focus 38 dB above spherical spreading. Fine structure
// spreads them over the depth H, where a family of the width w has r w / H: 8 dB for 0.03 rad.
TEST(SmoothedFolds, AFocusOfAFamilyNarrowerThanItsStepIsNone) {
  const std::vector<SpeedRow> rows{{0, 1500}, {12, 1499.4}};
  double still_db = -1e9, smoothed_db = -1e9;
  for (double range = 1900; range < 2600; range += 10) {
    for (const FineStructure& structure : {FineStructure(), kUsual}) {
      RaySea sea = smoothed_sea(rows, 12, structure);
      double& most_db = structure.is_perfect() ? still_db : smoothed_db;
      for (const Eigenray& path : eigenrays(sea, {6, 6, range}).paths)
        most_db = std::max(most_db, decibels(path.amplitude * path.amplitude * range * range));
    }
  }
  EXPECT_GT(still_db, 30);
  EXPECT_LT(smoothed_db, 9);
}

// Today's rays rise by 20 dB within some metres.
TEST(SmoothedFolds, ACuspIsNoFocus) {
  double least = 0, most = -1e9, ray = -1e9;
  for (double range = 2150; range <= 2300; ++range) {
    const double level = decibels(power_of(cusp_family(range, kUsual)));
    least = std::min(least, level);
    most = std::max(most, level);
    ray = std::max(ray, decibels(power_of(cusp_family(range, {}))));
  }
  EXPECT_LT(most - least, tolerance(1));
  EXPECT_GT(ray, most + 20);
}

TEST(SmoothedFolds, EvenWaterIsLeftToTheBit) {
  for (const RaySolver solver : {RaySolver::kImages, RaySolver::kSnell, RaySolver::kArcs}) {
    RaySea sea = smoothed_sea({{0, 1500}}, 100, kUsual);
    const std::vector<Eigenray> with = eigenrays(sea, {20, 70, 1500}, solver).paths;
    sea.options.fine_structure = {};
    const std::vector<Eigenray> without = eigenrays(sea, {20, 70, 1500}, solver).paths;
    ASSERT_EQ(with.size(), without.size());
    for (std::size_t i = 0; i < with.size(); ++i) EXPECT_EQ(with[i].amplitude, without[i].amplitude);
  }
}

TEST(SmoothedFolds, DelaysAndAnglesOfPathsStay) {
  RaySea sea = smoothed_sea(kSummer, 100, kUsual);
  const std::vector<Eigenray> with = eigenrays(sea, {40, 70, 2000}).paths;
  sea.options.fine_structure = {};
  std::vector<Eigenray> kept;
  for (const Eigenray& path : with) {
    if (!path.diffuse) kept.push_back(path);
  }
  const std::vector<Eigenray> without = eigenrays(sea, {40, 70, 2000}).paths;
  ASSERT_EQ(kept.size(), without.size());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    EXPECT_EQ(kept[i].delay_s, without[i].delay_s);
    EXPECT_EQ(kept[i].identity, without[i].identity);
    EXPECT_LE(kept[i].amplitude, without[i].amplitude);
  }
}

// Smoothing moves power over depth: its mean stays. A focus narrower than the step of depth is met by chance.
TEST(SmoothedFolds, TheMeanPowerOverDepthStays) {
  for (const double range : {1000.0, 2000.0}) {
    double with = 0, without = 0;
    for (double z = 0.5; z < 100; z += 0.5) {
      RaySea sea = smoothed_sea(kSummer, 100, kUsual);
      with += power_of(eigenrays(sea, {60, z, range}).paths);
      sea.options.fine_structure = {};
      without += power_of(eigenrays(sea, {60, z, range}).paths);
    }
    EXPECT_NEAR(decibels(with / without), 0, tolerance(0.5)) << range;
  }
}

TEST(SmoothedFolds, WindowsHaveIdentitiesOfTheirOwnAndPathsStaySorted) {
  const RaySea sea = smoothed_sea(kSummer, 100, kUsual);
  int windows = 0;
  for (double z = 2; z < 100; z += 7) {
    const std::vector<Eigenray> paths = eigenrays(sea, {40, z, 3000}).paths;
    std::set<std::uint64_t> numbers;
    for (std::size_t i = 0; i < paths.size(); ++i) {
      EXPECT_TRUE(numbers.insert(paths[i].identity.number()).second);
      windows += paths[i].diffuse ? 1 : 0;
      if (i > 0) {
        EXPECT_GE(paths[i].delay_s, paths[i - 1].delay_s);
      }
    }
  }
  EXPECT_GT(windows, 0);
}

// Over a level bottom the two solvers trace the same rays.
TEST(SmoothedFolds, BothSolversSmoothAlike) {
  const RaySea sea = smoothed_sea(kSummer, 100, kUsual);
  for (const double z : {25.0, 45.0, 75.0}) {
    const double snell = power_of(eigenrays(sea, {60, z, 2000}, RaySolver::kSnell).paths);
    const double arcs = power_of(eigenrays(sea, {60, z, 2000}, RaySolver::kArcs).paths);
    EXPECT_NEAR(decibels(arcs / snell), 0, tolerance(0.2)) << z;
  }
}

TEST(CycleRays, TheyEndWhereEigenraysDo) {
  const RaySea sea = smoothed_sea(kSummer, 100, {});
  for (const double z : {20.0, 60.0, 90.0}) {
    CycleRays rays(sea.water, 100, 60, 2500);
    for (const Eigenray& path : eigenrays(sea, {60, z, 2500}).paths) {
      const RangeEnd end = rays.at(path.launch_angle_rad);
      // Within the Airy length of a fold, or beside a knot, a path is not a ray.
      if (std::abs(path.launch_angle_rad) < 0.15) continue;
      EXPECT_NEAR(end.depth_m, z, tolerance(1e-4)) << path.launch_angle_rad;
      EXPECT_EQ(end.surface_bounces, path.surface_bounces);
      EXPECT_EQ(end.bottom_bounces, path.bottom_bounces);
      EXPECT_NEAR(end.sine, std::sin(path.arrival_angle_rad), tolerance(1e-6));
    }
  }
}

}  // namespace
}  // namespace halocline::acoustics
