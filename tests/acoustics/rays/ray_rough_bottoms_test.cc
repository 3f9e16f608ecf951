// SPDX-License-Identifier: BSD-3-Clause
// Rays over rough bottoms, where they are too many to be found one by one: strong paths and levels against
// the search of every ray.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/sea/bottom_profile.h"
#include "core/random.h"
#include "core/units.h"
#include "tests/acoustics/rays/layered_waters.h"
#include "tests/acoustics/rays/ray_reference.h"

namespace halocline::acoustics {
namespace {

using testing::tolerance;

RaySea every_ray(RaySea sea) {
  sea.options.diffuse_below_db = 0;
  return sea;
}

RaySea rough_sea(std::uint32_t seed, double range_m) {
  RaySea sea = sea_of(kRoughWater, rough_bottom(seed, range_m));
  sea.options = RayOptions{};
  return sea;
}

RayLink random_link(std::uint32_t index, double range_m) {
  const auto draw = [&](std::uint64_t which) {
    return uniform_at({.seed = 11, .purpose = purpose_of("rough bottoms"), .who = index, .which = which});
  };
  return {20 + 100 * draw(1), 20 + 100 * draw(2), range_m * (0.9 + 0.2 * draw(3))};
}

double power_of(const std::vector<Eigenray>& paths) {
  double power = 0;
  for (const Eigenray& path : paths) power += path.received_pressure() * path.received_pressure();
  return power;
}

bool has(const std::vector<Eigenray>& paths, const Eigenray& wanted) {
  // About a fold both searches find one path or two, by where they begin.
  return std::any_of(paths.begin(), paths.end(), [&](const Eigenray& path) {
    return !path.diffuse && path.surface_bounces == wanted.surface_bounces &&
           path.bottom_bounces == wanted.bottom_bounces &&
           std::abs(path.delay_s - wanted.delay_s) < tolerance(2e-5) &&
           std::abs(20 * std::log10(path.amplitude / wanted.amplitude)) < tolerance(3);
  });
}

struct Comparison {
  std::size_t strong = 0, lost = 0, paths = 0, all = 0;
  std::vector<double> errors_db;  // of the level, absolute, rising
  double mean_error_db = 0, diffuse_share = 0;
};

Comparison compare(double range_m, std::uint32_t links) {
  Comparison sum;
  for (std::uint32_t i = 0; i < links; ++i) {
    const RayLink link = random_link(i, range_m);
    const RaySea sea = rough_sea(i, link.range_m);
    const Eigenrays few = eigenrays(sea, link), every = eigenrays(every_ray(sea), link);
    double strongest = 0;
    for (const Eigenray& path : every.paths) strongest = std::max(strongest, path.received_pressure());
    for (const Eigenray& path : every.paths) {
      if (path.received_pressure() < strongest * std::pow(10.0, -15.0 / 20)) continue;
      ++sum.strong;
      if (!has(few.paths, path)) ++sum.lost;
    }
    sum.paths += few.paths.size();
    sum.all += every.paths.size();
    const double power = power_of(few.paths), error_db = 10 * std::log10(power / power_of(every.paths));
    sum.mean_error_db += error_db / links;
    sum.diffuse_share += few.diffuse_power() / power / links;
    sum.errors_db.push_back(std::abs(error_db));
  }
  std::sort(sum.errors_db.begin(), sum.errors_db.end());
  return sum;
}

// The search of every ray is itself some tenths of a percent short of them, at folds.
TEST(RoughBottoms, StrongPathsAndLevelsAreThoseOfEveryRayAtOneKilometre) {
  const Comparison found = compare(1000, 60);
  EXPECT_GT(found.strong, 500u);
  EXPECT_EQ(found.lost, 0u);
  EXPECT_LT(found.errors_db[30], tolerance(0.01));
  EXPECT_LT(found.errors_db.back(), tolerance(0.1));
}

TEST(RoughBottoms, StrongPathsAndLevelsAreThoseOfEveryRayAtTwoKilometres) {
  const Comparison found = compare(2000, 40);
  EXPECT_GT(found.strong, 900u);
  EXPECT_LE(static_cast<double>(found.lost), tolerance(0.01) * static_cast<double>(found.strong));
  EXPECT_LT(2 * found.paths, found.all);
  EXPECT_GT(found.diffuse_share, 0);
  EXPECT_LT(found.errors_db[20], tolerance(0.05));
  EXPECT_LT(found.errors_db[36], tolerance(0.3));
}

// Of weak paths alone most of the sound is diffuse: its level is theirs on the mean over places.
TEST(RoughBottoms, DiffusePowerIsThatOfThePathsItStandsFor) {
  double diffuse = 0, left_out = 0;
  for (std::uint32_t i = 0; i < 40; ++i) {
    const RayLink link = random_link(i, 2000);
    RaySea sea = rough_sea(i, link.range_m);
    sea.options.diffuse_below_db = 10;
    const Eigenrays few = eigenrays(sea, link);
    diffuse += few.diffuse_power();
    left_out += power_of(eigenrays(every_ray(sea), link).paths) - power_of(few.paths) + few.diffuse_power();
  }
  EXPECT_GT(diffuse, 0);
  EXPECT_NEAR(10 * std::log10(diffuse / left_out), 0, tolerance(1));
}

// Paths that are weak by themselves are diffuse as those are that are weak beside the strongest.
TEST(RoughBottoms, PathsAboveThePressureAreKeptAndTheLevelStays) {
  double power = 0, of_every = 0;
  std::size_t strong = 0, lost = 0, few = 0, all = 0;
  for (std::uint32_t i = 0; i < 40; ++i) {
    const RayLink link = random_link(i, 2000);
    RaySea sea = rough_sea(i, link.range_m);
    const Eigenrays every = eigenrays(every_ray(sea), link);
    sea.options.diffuse_below_pressure = 1e-4;
    const Eigenrays found = eigenrays(sea, link);
    for (const Eigenray& path : every.paths) {
      if (path.received_pressure() < 2 * sea.options.diffuse_below_pressure) continue;
      ++strong;
      if (!has(found.paths, path)) ++lost;
    }
    power += power_of(found.paths);
    of_every += power_of(every.paths);
    few += found.paths.size();
    all += every.paths.size();
  }
  EXPECT_GT(strong, 200u);
  EXPECT_LE(static_cast<double>(lost), tolerance(0.01) * static_cast<double>(strong));
  EXPECT_LT(4 * few, all);
  EXPECT_NEAR(10 * std::log10(power / of_every), 0, tolerance(0.3));
}

TEST(RoughBottoms, SmoothOnesAreSearchedForEveryRay) {
  for (const BottomProfile& bottom : {cosine_hill(), BottomProfile({{0, 200}, {5000, 140}}),
                                      BottomProfile({{0, 200}, {1500, 200}, {2500, 80}, {3500, 200}})}) {
    for (const double range_m : {500.0, 1700.0, 3000.0, 4500.0}) {
      RaySea sea = sea_of({{0, 1520}, {50, 1490}, {200, 1492}}, bottom);
      sea.options = RayOptions{};
      const RayLink link{20, 50, range_m};
      const Eigenrays found = eigenrays(sea, link), every = eigenrays(every_ray(sea), link);
      ASSERT_EQ(found.paths.size(), every.paths.size()) << range_m;
      for (std::size_t i = 0; i < found.paths.size(); ++i) {
        EXPECT_EQ(found.paths[i].delay_s, every.paths[i].delay_s);
        EXPECT_EQ(found.paths[i].amplitude, every.paths[i].amplitude);
      }
    }
  }
}

TEST(RoughBottoms, PathsComeByDelayAndEachHasAnIdentity) {
  const RayLink link = random_link(1, 3000);
  const std::vector<Eigenray> paths = eigenrays(rough_sea(1, link.range_m), link).paths;
  std::vector<PathIdentity> identities;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (i > 0) {
      EXPECT_LE(paths[i - 1].delay_s, paths[i].delay_s);
    }
    identities.push_back(paths[i].identity);
  }
  EXPECT_TRUE(std::any_of(paths.begin(), paths.end(), [](const Eigenray& path) { return path.diffuse; }));
  std::sort(identities.begin(), identities.end());
  EXPECT_EQ(std::adjacent_find(identities.begin(), identities.end()), identities.end());
}

}  // namespace
}  // namespace halocline::acoustics
