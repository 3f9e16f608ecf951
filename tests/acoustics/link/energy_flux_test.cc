// SPDX-License-Identifier: BSD-3-Clause
// The energy of links whose rays are mixed, against the integral over a channel of one speed and against
// every ray over rough bottoms.
#include "acoustics/link/energy_flux.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/boundary_reflection.h"
#include "core/random.h"
#include "core/units.h"
#include "tests/acoustics/rays/layered_waters.h"
#include "tests/acoustics/rays/ray_reference.h"

namespace halocline::acoustics {
namespace {

using testing::tolerance;

double power_of(const std::vector<Eigenray>& paths) {
  double power = 0;
  for (const Eigenray& path : paths) power += path.received_pressure() * path.received_pressure();
  return power;
}

double decibels(double power) { return 10 * std::log10(power); }

// In even water half a cycle is H cot(angle) long: the power is 2 / (r H) times the integral of R^(r
// tan(angle) / H).
TEST(EnergyFluxLink, OfOneSpeedIsTheIntegralOverTheChannel) {
  const RaySea sea = sea_of({{0, 1500}}, BottomProfile::flat(100), [](double) { return 0.0; });
  for (const double range : {2000.0, 5000.0, 10'000.0}) {
    constexpr int kAngles = 20'000;
    const double limit = sea.options.max_launch_angle_rad, width = limit / kAngles;
    double integral = 0;
    for (int i = 0; i < kAngles; ++i) {
      const double angle = (i + 0.5) * width;
      integral += width * std::pow(bottom_magnitude_at_sine(sea.bottom, std::sin(angle), 1500),
                                   range * std::tan(angle) / 100);
    }
    const auto windows =
        energy_flux_eigenrays({sea.water, 100, sea.bottom, sea.surface, sea.options}, {40, 70, range});
    EXPECT_NEAR(decibels(power_of(windows)), decibels(2 * integral / (range * 100)), tolerance(0.3)) << range;
    for (const Eigenray& window : windows) {
      EXPECT_NEAR(window.delay_s, range / 1500 / std::cos(window.launch_angle_rad), 1e-9);
      EXPECT_TRUE(window.diffuse);
    }
  }
}

// Mixed rays beside all rays, over links 0.9 to 1.1 of the range long above bottoms with 5 m of relief. Less
// relief mixes rays less: over 2 m the deviation from place to place is 2 dB.
struct MeanError {
  double db = 0, rms_db = 0;
};
MeanError error_over(double range_m) {
  constexpr std::uint32_t kLinks = 40;
  MeanError error;
  double squares = 0;
  for (std::uint32_t i = 0; i < kLinks; ++i) {
    const auto draw = [&](std::uint64_t which) {
      return uniform_at({.seed = 3, .purpose = purpose_of("mixed"), .who = i, .which = which});
    };
    const RayLink link{20 + 80 * draw(0), 20 + 80 * draw(1), range_m * (0.9 + 0.2 * draw(2))};
    RaySea sea = sea_of(kRoughWater, rough_bottom(i, link.range_m));
    sea.options = RayOptions{};
    double depth = 0;
    for (int place = 0; place < 16; ++place)
      depth += sea.bottom_profile.depth_at(link.range_m * (place + 0.5) / 16) / 16;
    const EnergyFluxSea mixed{sea.water, depth, sea.bottom, sea.surface, sea.options};
    const double error_db =
        decibels(power_of(energy_flux_eigenrays(mixed, link)) / power_of(eigenrays(sea, link).paths));
    error.db += error_db / kLinks;
    squares += error_db * error_db / kLinks;
  }
  error.rms_db = std::sqrt(squares);
  return error;
}

// Over places; the mean of 40 is known within 0.25 dB, so that of a right model lies within 0.75 of 0 in 997
// of 1000 draws.
TEST(EnergyFluxLink, IsOnTheMeanWhatEveryRayBringsOverRoughBottoms) {
  for (const double range : {2000.0, 3000.0, 4000.0}) {
    const MeanError error = error_over(range);
    EXPECT_NEAR(error.db, 0, tolerance(0.75)) << range;
    EXPECT_LT(error.rms_db, tolerance(2)) << range;
  }
}

// A ray that turns above the receiver does not come to it.
TEST(EnergyFluxLink, NothingComesToWhereNoRayDoes) {
  RaySea sea = sea_of({{0, 1500}, {50, 1480}, {100, 1500}, {1000, 1600}}, BottomProfile::flat(1000));
  sea.options.max_launch_angle_rad = 0.05;  // its rays turn within 4 m of the axis
  const EnergyFluxSea mixed{sea.water, 1000, sea.bottom, sea.surface, sea.options};
  EXPECT_FALSE(energy_flux_eigenrays(mixed, {50, 52, 20'000}).empty());
  EXPECT_TRUE(energy_flux_eigenrays(mixed, {50, 120, 20'000}).empty());
}

TEST(FluxOnlyLink, IsLongAndThatFarBelowThePressure) {
  RaySea sea = sea_of(kRoughWater, rough_bottom(1, 4000));
  sea.options = RayOptions{};
  const RayLink link{40, 70, 4000};
  const auto weak = [&](double pressure, const RayLink& at, double below_db = 6) {
    sea.options.diffuse_below_pressure = pressure;
    return flux_only_eigenrays({sea.water, 150, sea.bottom, sea.surface, sea.options}, at,
                               Decibels{below_db});
  };
  EXPECT_FALSE(weak(0, link));
  const double level = std::sqrt(
      power_of(energy_flux_eigenrays({sea.water, 150, sea.bottom, sea.surface, sea.options}, link)));
  EXPECT_FALSE(weak(1.99 * level, link));
  EXPECT_FALSE(weak(0.70 * level, link, -3));
  EXPECT_TRUE(weak(0.72 * level, link, -3));
  const auto windows = weak(2.01 * level, link);
  ASSERT_TRUE(windows);
  EXPECT_NEAR(std::sqrt(power_of(*windows)), level, 1e-12 * level);
  EXPECT_FALSE(weak(1, {40, 70, 1499}));
  EXPECT_TRUE(weak(1, {40, 70, 1501}));
  sea.options.diffuse_below_db = 0;  // every path is wanted
  EXPECT_FALSE(weak(1, link));
}

class LeastFlux : public ::testing::Test {
 protected:
  RaySea sea_ = sea_of(kRoughWater, BottomProfile::flat(150));
  double loss_db(double depth_m, const RayLink& link) const {
    return -decibels(power_of(
        energy_flux_eigenrays({sea_.water, depth_m, sea_.bottom, sea_.surface, sea_.options}, link)));
  }
  LeastFluxLoss least(Decibels gain) const {
    return {{sea_.water, 150, sea_.bottom, sea_.surface, sea_.options}, {80, 250, 100}, gain};
  }
};

// Without the hundredth of the power that links leave out, and with what lies between the depths tried.
TEST_F(LeastFlux, NoLinkLosesLess) {
  const LeastFluxLoss bound = least(Decibels{0});
  double nearest_db = 1e9;
  for (std::uint32_t i = 0; i < 400; ++i) {
    const auto draw = [&](std::uint64_t which) {
      return uniform_at({.seed = 4, .purpose = purpose_of("mixed"), .who = i, .which = which});
    };
    const double depth = 80 + 170 * draw(0), deepest = std::min(depth, 100.0);
    const RayLink link{deepest * draw(1), deepest * draw(2), 2500 + 10'000 * draw(3)};
    const double excess_db = loss_db(depth, link) - bound.at(link.range_m).value;
    EXPECT_GT(excess_db, -0.3) << depth << ' ' << link.source_depth_m << ' ' << link.receiver_depth_m;
    nearest_db = std::min(nearest_db, excess_db);
  }
  EXPECT_LT(nearest_db, tolerance(2));  // no idle bound
}

TEST_F(LeastFlux, GainIsTakenOff) {
  EXPECT_NEAR((least(Decibels{0}).at(4000) - least(Decibels{6}).at(4000)).value, 6, 1e-9);
}

TEST_F(LeastFlux, TheRangeOfALossIsWhereItIsReached) {
  const LeastFluxLoss bound = least(Decibels{0});
  const Decibels weak{20};
  for (const double range_m : {3000.0, 6000.0, 12'000.0})
    EXPECT_NEAR(bound.range_of(bound.at(range_m), weak), range_m, 2e-4 * range_m);
}

TEST_F(LeastFlux, HoldsForFluxOnlyLinksAlone) {
  const LeastFluxLoss bound = least(Decibels{0});
  const Decibels loss = bound.at(6000);
  EXPECT_EQ(bound.range_of(loss, loss + Decibels{0.1}), std::numeric_limits<double>::infinity());
  EXPECT_GE(bound.range_of(Decibels{1}, Decibels{0}), 10 * 250);  // shorter links have their rays
}

}  // namespace
}  // namespace halocline::acoustics
