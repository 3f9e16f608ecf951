// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/link/slope_diffusion.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using testing::tolerance;

double angle_of(std::size_t ray, double width_rad) { return (static_cast<double>(ray) + 0.5) * width_rad; }

// With cycles of one length Legendre's polynomial P2(cos(angle)) only fades, as exp(-12 s2 r / X); a level
// stays.
TEST(SlopeDiffusion, FadesAsLegendrePolynomialsDo) {
  constexpr std::size_t kRays = 90;
  constexpr double kWidth = std::numbers::pi / 2 / kRays, kCycle = 800, kSquare = 0.01, kRange = 4000;
  const auto p2 = [](double angle) { return 1.5 * std::cos(angle) * std::cos(angle) - 0.5; };
  std::vector<BottomRay> rays;
  for (std::size_t i = 0; i < kRays; ++i) rays.push_back({kCycle, 0, 2 + p2(angle_of(i, kWidth))});
  diffuse_by_slopes(rays, kWidth, kSquare, kRange);
  const double faded = std::exp(-12 * kSquare * kRange / kCycle);
  for (std::size_t i = 0; i < kRays; ++i)
    EXPECT_NEAR(rays[i].power, 2 + faded * p2(angle_of(i, kWidth)), tolerance(0.02)) << i;
}

TEST(SlopeDiffusion, KeepsTheEnergyOfAllAnglesWhateverTheirCycles) {
  constexpr double kWidth = 0.025;
  std::vector<BottomRay> rays;
  for (std::size_t i = 0; i < 40; ++i)
    rays.push_back({300 / std::tan(angle_of(i, kWidth)), 0, i < 10 ? 1.0 : 0});
  const auto energy = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < rays.size(); ++i)
      sum += rays[i].power * rays[i].cycle_m * std::sin(angle_of(i, kWidth));
    return sum;
  };
  const double before = energy();
  diffuse_by_slopes(rays, kWidth, 0.004, 5000);
  EXPECT_NEAR(energy(), before, 1e-12 * before);
  EXPECT_LT(rays[0].power, 0.9);
  EXPECT_GT(rays[20].power, 0.01);
}

TEST(SlopeDiffusion, OverALevelSeabedEachRayLosesItsOwn) {
  std::vector<BottomRay> rays;
  for (std::size_t i = 0; i < 8; ++i) rays.push_back({500, 1e-4 * static_cast<double>(i), 3});
  diffuse_by_slopes(rays, 0.03, 0, 6000);
  for (std::size_t i = 0; i < rays.size(); ++i)
    EXPECT_NEAR(rays[i].power, 3 * std::exp(-0.6 * static_cast<double>(i)), 1e-12);
}

}  // namespace
}  // namespace halocline::acoustics
