// SPDX-License-Identifier: BSD-3-Clause
// What the limits of the search keep and drop, links of hardly any range, and what rays note of their
// bounces.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/boundary_reflection.h"
#include "core/check.h"
#include "tests/acoustics/rays/brute_fan.h"
#include "tests/acoustics/rays/layered_waters.h"
#include "tests/acoustics/rays/ray_reference.h"

namespace halocline::acoustics {
namespace {

using testing::tolerance;

double power_of(const Eigenrays& found) {
  double sum = 0;
  for (const Eigenray& path : found.paths) sum += path.received_pressure() * path.received_pressure();
  return sum;
}

double bounce_loss_db(const Eigenray& path) { return path.surface_loss_db + path.bottom_loss_db; }

const Eigenray& strongest(const Eigenrays& found) {
  return *std::max_element(found.paths.begin(), found.paths.end(), [](const Eigenray& a, const Eigenray& b) {
    return a.received_pressure() < b.received_pressure();
  });
}

// Every path is bent down into clay, which takes 10 dB and more of each bounce.
RaySea thermocline_over_clay(double limit_db) {
  RaySea sea = sea_of(kThermocline, BottomProfile::flat(100), [](double) { return 1.3; });
  sea.bottom = *sediment("Clay");
  sea.options.min_boundary_factor = std::pow(10.0, -limit_db / 20);
  return sea;
}

// ---------------------------------------------------------------------------------------------- limits

TEST(RayLimits, TheOnlyPathsAreKeptWhateverTheirBouncesLose) {
  for (const RaySolver solver : {RaySolver::kSnell, RaySolver::kArcs}) {
    for (const double range : {1500.0, 2500.0, 3500.0, 6000.0}) {
      const RayLink link{10, 12, range};
      const Eigenrays found = eigenrays(thermocline_over_clay(30), link, solver);
      const Eigenrays all = eigenrays(thermocline_over_clay(200), link, solver);
      ASSERT_FALSE(found.silent()) << range;
      // What is dropped lies 30 dB and more below.
      EXPECT_NEAR(10 * std::log10(power_of(found) / power_of(all)), 0, 0.05)
          << range << " by " << to_name(solver);
    }
  }
}

TEST(RayLimits, PathsAreDroppedByWhatTheirBouncesLoseBeyondTheStrongest) {
  const RayLink link{10, 12, 3500};
  const Eigenrays found = eigenrays(thermocline_over_clay(30), link),
                  all = eigenrays(thermocline_over_clay(200), link);
  const double most = bounce_loss_db(strongest(found)) + 30;
  EXPECT_GT(bounce_loss_db(strongest(found)), 30);
  std::size_t expected = 0;
  for (const Eigenray& path : all.paths) expected += bounce_loss_db(path) <= most ? 1 : 0;
  EXPECT_EQ(found.paths.size(), expected);
  EXPECT_LT(found.paths.size(), all.paths.size());
  for (const Eigenray& path : found.paths) EXPECT_LE(bounce_loss_db(path), most + tolerance(1e-9));
}

// Over shallow water of rough boundaries few bounced paths have a coherent share: the others are not
// searched.
TEST(RayLimits, PathsWithoutACoherentShareAreDroppedAndNoOthers) {
  using Solver = RaySolver;
  const std::vector<SpeedRow> even{{0, 1500}}, bent{{0, 1510}, {8, 1506}, {30, 1503}};
  for (const Solver solver : {Solver::kImages, Solver::kSnell, Solver::kArcs}) {
    RaySea sea = sea_of(solver == Solver::kImages ? even : bent, BottomProfile::flat(20));
    const RayLink link{5, 12, 600};
    const Eigenrays all = eigenrays(sea, link, solver);
    sea.options.scattering = {.surface = 400, .bottom = 40};
    const Eigenrays found = eigenrays(sea, link, solver);
    const auto is_left = [&](const Eigenray& path) {
      const double nepers =
          sea.options.scattering.nepers(path.surface_sine_squares, path.bottom_sine_squares);
      return path.surface_bounces + path.bottom_bounces < 2 || nepers <= BounceScattering::kMaxNepers;
    };
    std::vector<Eigenray> expected;
    for (const Eigenray& path : all.paths)
      if (is_left(path)) expected.push_back(path);
    EXPECT_GT(expected.size(), 5U) << to_name(solver);
    EXPECT_LT(expected.size(), all.paths.size() / 2) << to_name(solver);
    ASSERT_EQ(found.paths.size(), expected.size()) << to_name(solver);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_NEAR(found.paths[i].delay_s, expected[i].delay_s, tolerance(1e-9)) << to_name(solver);
      EXPECT_NEAR(found.paths[i].amplitude / expected[i].amplitude, 1, tolerance(1e-6)) << to_name(solver);
    }
  }
}

TEST(RayLimits, AReceiverBelowTheSourceIsNoShadow) {
  for (const auto& knots : {kThermocline, std::vector<SpeedRow>{{0, 1500}}}) {
    RaySea sea = sea_of(knots, BottomProfile::flat(100));
    for (const double range : {0.0, 0.001, 0.5, 1.0}) {
      EXPECT_TRUE(has_direct_path(eigenrays(sea, {20, 30, range}))) << range;
      EXPECT_TRUE(has_direct_path(eigenrays(sea, {20, 30, range}, RaySolver::kArcs))) << range;
    }
    sea.options.keep_steep_direct = false;
    const Eigenrays found = eigenrays(sea, {20, 30, 0.5});
    EXPECT_TRUE(found.silent());
    EXPECT_EQ(found.lack, PathLack::kTooSteep);
    EXPECT_FALSE(found.shadow());
  }
}

TEST(RayLimits, WhatALeastAmplitudeDropsIsTooWeak) {
  RaySea sea = sea_of(kThermocline, BottomProfile::flat(100));
  sea.options.min_amplitude = 0.1;
  for (const RaySolver solver : {RaySolver::kSnell, RaySolver::kArcs}) {
    const Eigenrays found = eigenrays(sea, {20, 80, 2000}, solver);
    EXPECT_TRUE(found.silent());
    EXPECT_EQ(found.lack, PathLack::kTooWeak);
  }
}

TEST(RayLimits, OnlyWhereNoRayArrivesIsAShadow) {
  RaySea sea = sea_of({{0, 1520}, {100, 1490}}, BottomProfile::flat(100));
  sea.bottom = FluidBottom{1, 1, 0, 0, BottomLoss::kComplexWaveNumber};  // more water: no echo
  for (const RaySolver solver : {RaySolver::kSnell, RaySolver::kArcs}) {
    EXPECT_TRUE(eigenrays(sea, {10, 10, 2000}, solver).shadow());
  }
}

// ---------------------------------------------------------------------------------------------- hardly any
// range

TEST(RayLimits, WithinOneMetreTheDirectPathTakesItsTimeAtTheLevelOfOneMetre) {
  const BottomProfile slope({{0, 90}, {2000, 60}});
  for (const auto& knots : {kSummer, std::vector<SpeedRow>{{0, 1500}}}) {
    for (const BottomProfile& bottom : {BottomProfile::flat(90), slope}) {
      const RaySea sea = sea_of(knots, bottom);
      for (const RayLink link :
           {RayLink{40, 40, 0}, RayLink{40, 40, 1e-3}, RayLink{40, 40.5, 0.1}, RayLink{40, 39.4, 0}}) {
        const Eigenrays found = eigenrays(sea, link);
        ASSERT_TRUE(has_direct_path(found)) << link.range_m;
        const Eigenray& direct = found.paths.front();
        EXPECT_NEAR(direct.amplitude, 1, 0.001) << link.range_m;
        const double distance_m = std::hypot(link.range_m, link.receiver_depth_m - link.source_depth_m);
        EXPECT_NEAR(direct.delay_s, distance_m / sea.water.speed_at(40), 1e-6) << link.range_m;
        EXPECT_NEAR(direct.path_length_m, distance_m, 1e-3) << link.range_m;
      }
    }
  }
}

TEST(RayLimits, WithinOneMetreEchoesAreThoseOfTheirImages) {
  const RaySea sea = sea_of({{0, 1500}}, BottomProfile::flat(90));
  const Eigenrays found = eigenrays(sea, {0.9, 0.9, 0.4});
  ASSERT_GE(found.paths.size(), 2U);
  const Eigenray& surface = found.paths[1];
  ASSERT_EQ(surface.surface_bounces, 1);
  EXPECT_NEAR(surface.delay_s, std::hypot(1.8, 0.4) / 1500, tolerance(1e-12));
  EXPECT_NEAR(surface.amplitude, 1 / std::hypot(1.8, 0.4), tolerance(1e-9));
}

// A surface echo of half a metre is no louder than the source level.
TEST(RayLimits, NoPathIsLouderThanAtOneMetre) {
  const RaySea sea = sea_of({{0, 1500}}, BottomProfile::flat(90));
  for (const Eigenray& path : eigenrays(sea, {0.2, 0.2, 0.3}).paths) EXPECT_LE(path.amplitude, 1.0001);
}

TEST(RayLimits, NothingIsUndefinedBetweenEndsAtOnePlace) {
  for (const auto& knots : {kSummer, std::vector<SpeedRow>{{0, 1500}}}) {
    const Eigenrays found = eigenrays(sea_of(knots, BottomProfile::flat(90)), {40, 40, 0});
    ASSERT_TRUE(has_direct_path(found));
    EXPECT_NEAR(found.paths.front().delay_s, 0, 1e-7);  // a ray bends by 0.1 mm in a metre
    for (const Eigenray& path : found.paths) {
      EXPECT_TRUE(std::isfinite(path.delay_s + path.amplitude + path.launch_angle_rad +
                                path.arrival_angle_rad + path.absorption_db));
    }
  }
}

TEST(RayLimits, FromOneMetreOnTheDirectPathIsThatOfItsDistance) {
  const RaySea sea = sea_of({{0, 1500}}, BottomProfile::flat(90));
  const Eigenrays found = eigenrays(sea, {40, 41.2, 0.5});
  EXPECT_NEAR(found.paths.front().amplitude, 1 / 1.3, tolerance(1e-12));
  EXPECT_NEAR(found.paths.front().delay_s, 1.3 / 1500, tolerance(1e-15));
}

TEST(RayLimits, AReceiverUnderTheBottomIsRefusedAtAnyRange) {
  const RaySea sea = sea_of({{0, 1500}}, BottomProfile({{0, 90}, {10, 40}}));
  EXPECT_NO_THROW(eigenrays(sea, {89, 89, 0.01}));
  EXPECT_THROW(eigenrays(sea, {89, 91, 0.01}), InvalidArgument);
}

TEST(PathIdentity, IsThatOfItsNumber) {
  const PathIdentity identity{true, 400, 399, 3, 16'383, 127};
  EXPECT_EQ(PathIdentity::of_number(identity.number()), identity);
  EXPECT_EQ(PathIdentity::of_number(~std::uint64_t{0}).number(), ~std::uint64_t{0});
  EXPECT_EQ((PathIdentity{.branch = 17}).number(), 17u);
}

// ---------------------------------------------------------------------------------------------- bounces

// Over a flat bottom of one speed every bounce of a path has one grazing angle, its launch angle.
TEST(RayBounces, SumsOfSquaredSinesAreThoseOfTheGrazingAngle) {
  const RaySea sea = sea_of({{0, 1500}}, BottomProfile::flat(100));
  for (const RaySolver solver : {RaySolver::kImages, RaySolver::kSnell, RaySolver::kArcs}) {
    const Eigenrays found = eigenrays(sea, {30, 70, 1500}, solver);
    EXPECT_GT(found.paths.size(), 20u);
    for (const Eigenray& path : found.paths) {
      const double sine = std::sin(path.launch_angle_rad);
      EXPECT_NEAR(path.surface_sine_squares, path.surface_bounces * sine * sine, tolerance(1e-9))
          << describe(path) << " by " << to_name(solver);
      EXPECT_NEAR(path.bottom_sine_squares, path.bottom_bounces * sine * sine, tolerance(1e-9))
          << describe(path) << " by " << to_name(solver);
    }
  }
}

// In layered water the grazing angles at surface and bottom follow from Snell's law.
TEST(RayBounces, SumsOfSquaredSinesFollowSnellsLawInLayers) {
  const RaySea sea = sea_of(kSummer, BottomProfile::flat(120));
  const double at_surface = sea.water.speed_at(0), at_bottom = sea.water.speed_at(120);
  for (const RaySolver solver : {RaySolver::kSnell, RaySolver::kArcs}) {
    const Eigenrays found = eigenrays(sea, {15, 90, 3000}, solver);
    EXPECT_GT(found.paths.size(), 20u);
    for (const Eigenray& path : found.paths) {
      const auto squared_sine = [&](double speed) {
        const double cosine = path.launch_slowness_spm * speed;
        return 1 - cosine * cosine;
      };
      const double surface = path.surface_bounces == 0 ? 0 : path.surface_bounces * squared_sine(at_surface);
      const double bottom = path.bottom_bounces == 0 ? 0 : path.bottom_bounces * squared_sine(at_bottom);
      EXPECT_NEAR(path.surface_sine_squares, surface, tolerance(1e-9)) << describe(path);
      EXPECT_NEAR(path.bottom_sine_squares, bottom, tolerance(1e-9)) << describe(path);
    }
  }
}

}  // namespace
}  // namespace halocline::acoustics
