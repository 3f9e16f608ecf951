// SPDX-License-Identifier: BSD-3-Clause
// Rays that all but graze a boundary or turn beside a knot: the functions that give them the range of waves,
// and the field about them against the integral over all waves.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <vector>

#include <boost/math/special_functions/airy.hpp>
#include <gtest/gtest.h>

#include "acoustics/math/airy.h"
#include "acoustics/math/turning_field.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/sea/bottom_profile.h"
#include "tests/acoustics/rays/ray_reference.h"

namespace halocline::acoustics {
namespace {

using boost::math::airy_ai, boost::math::airy_bi;
using std::numbers::pi;

constexpr double kFrequency = 25'000;

double decibels(double ratio) { return 20 * std::log10(ratio); }

TEST(Airy, AgreesWithItsSeriesElsewhere) {
  for (double z = -5; z <= 5; z += 0.1) {
    const Airy a = airy(z);
    const double scale = std::max(1.0, boost::math::airy_bi(z)) * 1e-10;
    EXPECT_NEAR(a.ai, airy_ai(z), scale);
    EXPECT_NEAR(a.bi, airy_bi(z), scale);
    EXPECT_NEAR(a.ai_slope, boost::math::airy_ai_prime(z), 3 * scale);
    EXPECT_NEAR(a.bi_slope, boost::math::airy_bi_prime(z), 3 * scale);
  }
}

// Phase, its slope and the slope of that belong together wherever they are not being faded out.
TEST(TurningField, RangeIsTheSlopeOfThePhase) {
  constexpr double kStep = 1e-4;
  const auto phase = [](auto share, double x) {
    return share(x).phase + (x > 0 ? 2.0 / 3 * std::pow(x, 1.5) : 0);
  };
  const auto sine = [](auto share, double x) { return share(x).sine + (x > 0 ? std::sqrt(x) : 0); };
  for (const auto share : {turning_at_boundary, turning_at_knot}) {
    for (double x = -3.95; x < 2.4; x += 0.1) {
      EXPECT_NEAR((phase(share, x + kStep) - phase(share, x - kStep)) / (2 * kStep), sine(share, x), 1e-5)
          << x;
      EXPECT_NEAR((sine(share, x + kStep) - sine(share, x - kStep)) / kStep, share(x).slope, 1e-4) << x;
    }
  }
}

TEST(TurningField, AtABoundaryItIsAirys) {
  for (double x = -3.9; x < 2.4; x += 0.1) {
    const double ai = airy_ai(-x), bi = airy_bi(-x);
    EXPECT_NEAR(turning_at_boundary(x).sine + (x > 0 ? std::sqrt(x) : 0), 1 / (pi * (ai * ai + bi * bi)),
                1e-9);
  }
}

TEST(TurningField, RaysAreTheirOwnFurtherAway) {
  const double last = kSteepTurning - 1e-6;
  for (const auto share : {turning_at_boundary, turning_at_knot}) {
    EXPECT_NEAR(share(last).sine, 0, 1e-6);
    EXPECT_NEAR(share(last).slope, 1 / std::sqrt(last), 1e-6);
    EXPECT_NEAR(share(kDeepTurning).sine, 0, 1e-4);
    EXPECT_NEAR(share(kDeepTurning).phase, 0, 1e-4);
  }
  EXPECT_NEAR(turning_at_boundary(last).phase, pi / 4, 1e-6);
  EXPECT_NEAR(turning_at_knot(last).phase, 0, 1e-6);
}

// Water of 1 / c^2 = (1 + a z) / c0^2 below a surface, without a bottom. Each wave of horizontal number kappa
// is one of Airy's functions, and the field their sum (Brekhovskikh and Godin 1999, chapter 3).
constexpr double kSurfaceSpeed = 1513.5, kGradient = 0.11, kSlope = 2 * kGradient / kSurfaceSpeed;

double pressure_of_waves(double source_m, double receiver_m, double range_m) {
  const double k0 = 2 * pi * kFrequency / kSurfaceSpeed, beta = std::cbrt(k0 * k0 * kSlope);
  const auto t = [&](double z, double kappa) {
    return (kappa * kappa - k0 * k0 * (1 + kSlope * z)) / (beta * beta);
  };
  const double upper = std::min(source_m, receiver_m), lower = std::max(source_m, receiver_m);
  // Up to waves that have all but vanished at the upper end.
  const double from = k0 * std::cos(to_radians(4));
  const double to = k0 * std::sqrt(1 + kSlope * upper) + 4 * beta * beta / (2 * k0);
  const int steps = static_cast<int>((to - from) * range_m * 2);
  std::complex<double> sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double share = (i + 0.5) / steps, kappa = from + share * (to - from);
    const double t0 = t(0, kappa), t1 = t(upper, kappa), t2 = t(lower, kappa);
    const double standing = airy_ai(t1) * airy_bi(t0) - airy_bi(t1) * airy_ai(t0);
    const std::complex<double> outgoing(airy_bi(t2), airy_ai(t2)), surface(airy_bi(t0), airy_ai(t0));
    // Steep waves, which bring rays nearer to the source, are faded out.
    const double window = share < 0.5 ? std::pow(std::sin(pi * share), 2) : 1;
    sum += window * standing * outgoing / surface * std::polar(std::sqrt(kappa), kappa * range_m);
  }
  return std::abs(sum) * (to - from) / steps * 2 * pi / beta / std::sqrt(2 * pi * range_m);
}

double pressure_of_rays(double source_m, double receiver_m, double range_m) {
  std::vector<SpeedRow> rows;
  for (double z = 0; z <= 200; z += 5) rows.push_back({z, kSurfaceSpeed / std::sqrt(1 + kSlope * z)});
  RaySea sea = sea_of(rows, BottomProfile::flat(150));
  sea.options.airy_folds = true;
  std::complex<double> sum = 0;
  for (const Eigenray& path : eigenrays(sea, {source_m, receiver_m, range_m}, RaySolver::kSnell).paths) {
    if (path.bottom_bounces > 0) continue;
    sum += std::polar(path.amplitude, path.phase_rad - 2 * pi * std::fmod(kFrequency * path.delay_s, 1.0));
  }
  return std::abs(sum);
}

// The last ray below the surface comes 1838 m far; the field there is 13 dB below that of the lit side, and
// 10 dB less 80 m on.
TEST(RayTurning, TheEdgeOfASurfaceShadowIsThatOfWaves) {
  for (double range = 1400; range <= 1920; range += 20) {
    const double off = decibels(pressure_of_rays(25, 37, range) / pressure_of_waves(25, 37, range));
    EXPECT_NEAR(off, 0, range <= 1800 ? 0.8 : 2.1) << range;
  }
}

// The greatest change from one level to the next, dB.
double greatest_step(const std::vector<double>& levels) {
  double greatest = 0;
  for (std::size_t i = 1; i < levels.size(); ++i)
    greatest = std::max(greatest, std::abs(levels[i] - levels[i - 1]));
  return greatest;
}

// Each metre beside the edge, where a path appears, changes from turning to being reflected, or vanishes.
double greatest_surface_step(bool waves) {
  RaySea sea = sea_of({{0, 1513.5}, {100, 1502.5}, {12'000, 1502.5}}, BottomProfile::flat(60));
  sea.options.airy_folds = waves;
  std::vector<double> levels;
  for (int i = 0; i <= 400; ++i) {
    double power = 0;
    for (const Eigenray& path : eigenrays(sea, {25, 37, 2200.0 + i}, RaySolver::kSnell).paths)
      power += path.amplitude * path.amplitude;
    levels.push_back(10 * std::log10(power));
  }
  return greatest_step(levels);
}

TEST(RayTurning, LevelsHaveNoStepWhereRaysBeginToGrazeTheSurface) {
  EXPECT_LT(greatest_surface_step(true), 0.3);
  EXPECT_GT(greatest_surface_step(false), 1);
}

// The thermocline of a shelf in summer, as sampled.
const std::vector<SpeedRow> kThermocline = {
    {0, 1530.162},     {15, 1530.4065},     {16.875, 1528.1585}, {18.75, 1525.8523},  {20.625, 1523.487},
    {22.5, 1521.0616}, {24.375, 1518.5752}, {26.25, 1516.0268},  {28.125, 1513.4154}, {30, 1510.7401},
    {40, 1507.7314},   {50, 1504.6365},     {100, 1505.4575}};

// Each centimetre of a source below a row at which the ray to the receiver comes to turn.
double greatest_row_step(bool waves) {
  RaySea sea = sea_of(kThermocline, BottomProfile::flat(100));
  sea.options.airy_folds = waves;
  std::vector<double> levels;
  for (int i = 0; i <= 40; ++i) {
    double power = 0;
    for (const Eigenray& path : eigenrays(sea, {27.7 + 0.01 * i, 68.06, 491.39}, RaySolver::kSnell).paths) {
      if (path.surface_bounces + path.bottom_bounces == 0) power += path.amplitude * path.amplitude;
    }
    levels.push_back(10 * std::log10(power));
  }
  return greatest_step(levels);
}

TEST(RayTurning, LevelsHaveNoStepWhereRaysTurnAtAKnot) {
  EXPECT_LT(greatest_row_step(true), 0.2);
  EXPECT_GT(greatest_row_step(false), 1);
}

}  // namespace
}  // namespace halocline::acoustics
