// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/propagation/surface_ends.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "acoustics/sea/surface/surface_layers.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::tolerance;
using testing::at_s;
using testing::even_water;

acoustics::Environment windy(double wind_mps) {
  acoustics::Environment water = even_water();
  water.noise.wind_mps = wind_mps;
  return water;
}

struct Seen {
  double share = 0;  // of the instants under water
  double dives = 0;  // ends of stretches out of the water, per second
};

// Instants half a second apart over an hour, of 20 ends.
Seen seen(double depth_m, double wind_mps) {
  constexpr int kEnds = 20, kInstants = 8000;
  constexpr double kStep = 0.5;
  const acoustics::Environment water = windy(wind_mps);
  Seen all;
  for (VehicleId id = 1; id <= kEnds; ++id) {
    const SurfaceEnds ends{.seed = 7};
    bool before = true;
    for (int i = 0; i < kInstants; ++i) {
      const bool now = ends.is_under_water(id, depth_m, water, at_s(kStep * i));
      all.share += now ? 1 : 0;
      all.dives += now && !before ? 1 : 0;
      before = now;
    }
  }
  all.share /= kEnds * kInstants;
  all.dives /= kEnds * kInstants * kStep;
  return all;
}

// The sum of sixteen sines is Gaussian to within half a hundredth of probability.
TEST(SurfaceEnds, AreUnderWaterForTheShareOfTheWaves) {
  const SurfaceEnds ends;
  for (const double depth_m : {0.0, 0.5, 1.5}) {
    const double share = ends.share_under_water(1, depth_m, windy(14));
    EXPECT_EQ(share, acoustics::surface_waves(14).share_under_water(depth_m));
    EXPECT_NEAR(seen(depth_m, 14).share, share, tolerance(0.01)) << depth_m;
  }
  EXPECT_NEAR(ends.share_under_water(1, 0.5, windy(14)), 0.675281858137, tolerance(1e-12));
}

// Rice 1944: a Gaussian process passes zero upwards omega_m / (2 pi) times a second.
TEST(SurfaceEnds, EmergeInStretchesOfTheWavesTime) {
  const double per_second = acoustics::surface_waves(14).mean_frequency_radps / (2 * std::numbers::pi);
  EXPECT_NEAR(seen(0, 14).dives, per_second, tolerance(0.03 * per_second));
}

TEST(SurfaceEnds, FloatingOnesAreAlwaysUnderWater) {
  const SurfaceEnds ends{.floating = {3}};
  EXPECT_EQ(ends.share_under_water(3, 0.1, windy(20)), 1);
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(ends.is_under_water(3, 0.1, windy(20), at_s(i)));
}

TEST(SurfaceEnds, WithoutWavesTheSurfaceDecides) {
  const SurfaceEnds ends;
  acoustics::Environment low = windy(0);
  low.sea_surface_z_m = 1;
  EXPECT_FALSE(ends.is_under_water(1, 0.9, low, at_s(0)));
  EXPECT_TRUE(ends.is_under_water(1, 1.1, low, at_s(0)));
  EXPECT_EQ(ends.share_under_water(1, 0.9, low), 0);
}

TEST(SurfaceEnds, EachHasWavesOfItsOwnThatDependOnTheSeed) {
  const acoustics::Environment water = windy(14);
  int same_end = 0, same_seed = 0;
  for (int i = 0; i < 1000; ++i) {
    const SurfaceEnds ends{.seed = 1}, others{.seed = 2};
    const SimTime at = at_s(7.3 * i);
    same_end += ends.is_under_water(1, 0, water, at) == ends.is_under_water(2, 0, water, at) ? 1 : 0;
    same_seed += ends.is_under_water(1, 0, water, at) == others.is_under_water(1, 0, water, at) ? 1 : 0;
  }
  EXPECT_NEAR(same_end, 500, 120);
  EXPECT_NEAR(same_seed, 500, 120);
}

TEST(SurfaceEnds, MooredOnesDoNotHeave) {
  const SurfaceEnds ends{.floating = {1}, .heaving = {2}};
  EXPECT_GT(ends.heave_mps(1, 0, windy(10)), 0.6);
  EXPECT_EQ(ends.heave_mps(2, 0, windy(10)), ends.heave_mps(1, 0, windy(10)));
  EXPECT_EQ(ends.heave_mps(3, 0, windy(10)), 0);
}

}  // namespace
}  // namespace halocline::channel_server
