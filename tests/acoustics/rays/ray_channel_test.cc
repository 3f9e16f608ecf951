// SPDX-License-Identifier: BSD-3-Clause
// Sound channels and caustics of water given by rows: what kinks of the table must not make of them.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/rays/channel_core.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/ray_water.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "tests/acoustics/rays/brute_fan.h"
#include "tests/acoustics/rays/brute_ray.h"
#include "tests/acoustics/rays/layered_waters.h"
#include "tests/acoustics/rays/ray_reference.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;
using testing::tolerance;

std::vector<SpeedRow> munk_rows(double step_m) {
  std::vector<SpeedRow> rows;
  for (double z = 0; z <= 5000; z += step_m) rows.push_back({z, munk_sound_speed_mps(z)});
  return rows;
}

RaySea sea_on_load(const SoundSpeedProfile& profile, double frequency_hz = 25'000) {
  RaySea sea = sea_of({{0, 1500}}, BottomProfile::flat(5000));
  sea.water = RayWater::from_profile(profile, no_absorption);
  sea.options.frequency_hz = frequency_hz;
  return sea;
}

double level_without_bounces_db(const Eigenrays& found) {
  double sum = 0;
  for (const Eigenray& path : found.paths) {
    if (path.surface_bounces + path.bottom_bounces == 0) sum += path.amplitude * path.amplitude;
  }
  return 10 * std::log10(sum);
}

// Of Munk's own profile c'' = 4 eps c1 / B^2 on the axis, so that the axial ray has the tube sin(kappa r) /
// kappa.
const double kMunkKappa = 2 * std::sqrt(0.00737) / 1300;
double munk_axial_level_db(double range_m) {
  return 10 * std::log10(kMunkKappa / (range_m * std::sin(kMunkKappa * range_m)));
}

TEST(SoundChannel, OnTheAxisOfATabulatedMunkTheLevelIsThatOfTheSmoothOne) {
  const auto table = SoundSpeedProfile::from_speeds(munk_rows(50), {4, 35});
  for (const auto& profile : {table, SoundSpeedProfile::munk({4, 35})}) {
    for (const double frequency : {5e3, 25e3}) {
      const RaySea sea = sea_on_load(profile, frequency);
      for (const RaySolver solver : {RaySolver::kSnell, RaySolver::kArcs}) {
        for (const double range : {3000.0, 6000.0, 10'000.0}) {
          const Eigenrays found = eigenrays(sea, {1300, 1300, range}, solver);
          EXPECT_NEAR(level_without_bounces_db(found), munk_axial_level_db(range), 0.5)
              << frequency << " Hz, " << range << " m by " << to_name(solver);
        }
      }
    }
  }
}

TEST(SoundChannel, NearTheAxisTheLevelStaysThatOfTheSmoothMunk) {
  const RaySea sea = sea_on_load(SoundSpeedProfile::from_speeds(munk_rows(50), {4, 35}));
  for (const double off : {1.0, 3.0, 8.0, 12.0, 20.0, 40.0}) {
    for (const RaySolver solver : {RaySolver::kSnell, RaySolver::kArcs}) {
      const Eigenrays found = eigenrays(sea, {1300 + off, 1300 - off / 2, 10'000}, solver);
      EXPECT_NEAR(level_without_bounces_db(found), munk_axial_level_db(10'000), 1.0)
          << off << " m by " << to_name(solver);
    }
  }
}

TEST(SoundChannel, AThinnedTableKeepsTheLevelOnTheAxis) {
  Environment environment;
  environment.profile = SoundSpeedProfile::from_speeds(munk_rows(50), {4, 35});
  for (const double tolerance_mps : {0.02, 0.1}) {
    RaySea sea = sea_of({{0, 1500}}, BottomProfile::flat(5000));
    sea.water = ray_water(environment, 25'000, tolerance_mps);
    const Eigenrays found = eigenrays(sea, {1300, 1300, 10'000});
    EXPECT_NEAR(level_without_bounces_db(found), munk_axial_level_db(10'000), 1.0) << tolerance_mps;
  }
}

TEST(SoundChannel, TheCoreOfAParabolaHasItsCurvature) {
  // c = c0 (1 + kappa^2 z^2 / 2) about 500 m, in rows close together.
  constexpr double kKappa = 1e-3, kFrequency = 10e3;
  std::vector<SpeedRow> rows;
  for (double z = 300; z <= 700; z += 0.25) {
    const double off = kKappa * (z - 500);
    rows.push_back({z, 1500 * (1 + off * off / 2)});
  }
  const RayWater water(rows, no_absorption);
  const auto core = channel_core(water, 1000, {500, 500, 3000}, kFrequency);
  ASSERT_TRUE(core);
  EXPECT_NEAR(core->kappa_per_m / kKappa, 1, 0.01);
  // The widest swing has omega kappa h^2 / c = 1.
  const double h_squared = 1500 / (2 * pi * kFrequency * kKappa);
  EXPECT_NEAR(core->greatest_speed_mps - 1500, 1500 * kKappa * kKappa * h_squared / 2, 1e-4);
  EXPECT_FALSE(channel_core(water, 1000, {500, 510, 3000}, kFrequency));
  EXPECT_FALSE(channel_core(water, 501, {500, 501.5, 3000}, kFrequency));  // an end is under the bottom
}

TEST(SoundChannel, WaterWithoutAChannelHasNoCore) {
  for (const auto& knots :
       {std::vector<SpeedRow>{{0, 1500}}, kThermocline, std::vector<SpeedRow>{{0, 1490}, {90, 1500}}}) {
    for (const double depth : {0.0, 20.0, 50.0, 70.0}) {
      EXPECT_FALSE(channel_core(RayWater(knots, no_absorption), 100, {depth, depth, 1000}, 25e3)) << depth;
    }
  }
}

TEST(RoundedChannels, KeepRowsAndGradientsButForTheAxis) {
  const std::vector<SpeedRow> rows = munk_rows(50), rounded = rounded_channels(rows, 0.01);
  EXPECT_GT(rounded.size(), rows.size());
  const RayWater as_given(rows, no_absorption), water(rounded, no_absorption);
  double before = water.gradients_per_s().front(), greatest_kink = 0;
  for (double z = 0; z < 5000; z += 1) {
    EXPECT_LE(std::abs(water.speed_at(z) - as_given.speed_at(z)), 0.01 + 1e-9) << z;
    if (std::abs(z - 1300) > 25) {
      EXPECT_NEAR(water.speed_at(z), as_given.speed_at(z), tolerance(1e-9)) << z;
    }
  }
  for (std::size_t i = 0; i < water.layers(); ++i) {
    if (std::abs(water.depths_m()[i] - 1300) < 24)
      greatest_kink = std::max(greatest_kink, water.gradients_per_s()[i] - before);
    before = water.gradients_per_s()[i];
  }
  // The kink of the rows, 1.3e-3 per second, is shared out.
  EXPECT_LT(greatest_kink, 3e-4);
}

TEST(RoundedChannels, LeaveSharpKinksAsTheyAre) {
  EXPECT_EQ(rounded_channels(kSummer, 0.01).size(), kSummer.size());
  EXPECT_EQ(rounded_channels(kThermocline, 1).size(), kThermocline.size());
}

// Rows of 2 km make families that end at a row before they reach their caustic: there each ray has the level
// of its tube, whatever the frequency.
TEST(Folds, ARayWithoutAPartnerKeepsTheLevelOfItsTube) {
  const std::vector<SpeedRow> rows = {{0, munk_sound_speed_mps(0)},
                                      {2000, munk_sound_speed_mps(2000)},
                                      {4000, munk_sound_speed_mps(4000)},
                                      {6000, munk_sound_speed_mps(6000)}};
  const RayLink link{2866, 674, 48'600};
  for (const double frequency : {5e3, 25e3}) {
    RaySea sea = sea_of(rows, BottomProfile::flat(5500));
    sea.options.frequency_hz = frequency;
    sea.options.airy_folds = true;
    const BruteSea brute{rows, {{0, 5500}}, false, sea.bottom, 0.005};
    for (const RaySolver solver : {RaySolver::kSnell, RaySolver::kArcs}) {
      for (const Eigenray& path : eigenrays(sea, link, solver).paths) {
        if (path.surface_bounces + path.bottom_bounces > 0) continue;
        const auto ray = brute_eigenray(brute, link, path.launch_angle_rad);
        ASSERT_TRUE(ray) << describe(path);
        EXPECT_NEAR(20 * std::log10(path.amplitude / ray->amplitude), 0, 0.05)
            << describe(path) << " at " << frequency << " Hz by " << to_name(solver);
      }
    }
  }
}

}  // namespace
}  // namespace halocline::acoustics
