// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/prediction/steady_band.h"

#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>

#include <gtest/gtest.h>

#include "acoustics/math/frequency_band.h"
#include "acoustics/modem/modem.h"
#include "acoustics/prediction/platform_jitter.h"
#include "core/random.h"
#include "core/sim_time.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;
constexpr double kBandwidthHz = 4000;

Modem receiver() {
  Modem modem;
  modem.guard_time = SimDuration::from_milliseconds(10);
  return modem;
}

// Two paths of pressures 1 and r, `cycles` of interference over the band, apart by a phase.
SteadyBand two_paths(double r, double cycles, double phase_rad) {
  SteadyBand band(receiver(), {23'000, 23'000 + kBandwidthHz});
  band.add({1, 0, 0});
  band.add({r, phase_rad, cycles / kBandwidthHz});
  return band;
}

TEST(SteadyBand, OnePathIsConstant) {
  SteadyBand band(receiver(), {23'000, 27'000});
  band.add({3, 1, 0.004});
  for (const SteadyBand::Part& part : band.parts()) {
    EXPECT_NEAR(part.constant, 9, 1e-9);
    EXPECT_NEAR(part.varying, 0, 1e-9);
  }
}

// Whatever their phases: S = 1 + r^2, V = 2 r^2, so constant^2 = (1 + r^2)^2 - 2 r^2 = 1 + r^4.
TEST(SteadyBand, PathsWholeCyclesApartInEachPartKeepTheirPower) {
  constexpr double r = 0.7;
  for (const double cycles : {8.0, 16.0, 32.0, 64.0}) {
    for (const double phase_rad : {0.0, 1.0, pi}) {
      for (const SteadyBand::Part& part : two_paths(r, cycles, phase_rad).parts()) {
        EXPECT_NEAR(part.constant, std::sqrt(1 + std::pow(r, 4)), 1e-9) << cycles << " " << phase_rad;
        EXPECT_NEAR(part.constant + part.varying, 1 + r * r, 1e-9);
      }
    }
  }
}

// The mean over the band is 1 + r^2 + 2 r sinc(cycles) cos(phase at the middle).
TEST(SteadyBand, ClosePathsInterfere) {
  for (const double cycles : {0.0, 0.3, 1.5, 5.2}) {
    for (const double phase_rad : {0.0, 2.0, pi}) {
      const double x = pi * cycles, sinc = x > 0 ? std::sin(x) / x : 1;
      double mean = 0;
      for (const SteadyBand::Part& part : two_paths(1, cycles, phase_rad).parts()) {
        mean += (part.constant + part.varying) / kSignalFrequencies;
      }
      // The midpoint rule over 160 samples.
      EXPECT_NEAR(mean, 2 + 2 * sinc * std::cos(phase_rad - x), 1e-3 * (1 + cycles)) << cycles;
    }
  }
}

// In antiphase at the middle of the band, at sines of the angles apart by d: with g = exp(-(k 0.2 m d)^2 / 2)
// the mean is 2 - 2 g sinc and its variance that of 200 000 jittered ends.
TEST(SteadyBand, JitterTurnsPathsOfOtherAnglesAgainstEachOther) {
  constexpr double kWaveNumber = 2 * pi * 25'000 / 1500, kCycles = 0.4;
  const double sinc = std::sin(pi * kCycles) / (pi * kCycles);
  for (const double apart : {0.0, 0.02, 0.06, 0.3}) {
    SteadyBand band(receiver(), {23'000, 23'000 + kBandwidthHz});
    band.add({1, 0, 0, 0.1, 0});
    band.add({1, pi + pi * kCycles, kCycles / kBandwidthHz, 0.1 + apart, 0});
    double mean = 0, jittered = 0, square = 0;
    for (const SteadyBand::Part& part : band.parts()) {
      mean += (part.constant + part.varying) / kSignalFrequencies;
    }
    constexpr int kEnds = 200'000;
    for (int i = 0; i < kEnds; ++i) {
      const double jitter_m =
          kPlatformJitterM * normal_at({.seed = 3, .which = static_cast<std::uint64_t>(i)});
      const double power = 2 + 2 * sinc * std::cos(pi + kWaveNumber * apart * jitter_m);
      jittered += power / kEnds;
      square += power * power / kEnds;
    }
    EXPECT_NEAR(mean, jittered, 0.02) << apart;
    EXPECT_NEAR(band.jitter_variance(), square - jittered * jittered, 0.02) << apart;
  }
}

// A direct path and those by surface and bottom, as of a shallow basin, which partly cancel: their pairs turn
// together, so that the power varies by a quarter of its mean, not by one and a half as independent pairs
// would. Within a quarter of the deviation: orders above the second are taken as independent.
TEST(SteadyBand, JitterHardlyTurnsPathsThatCancelEachOther) {
  constexpr double kWaveNumber = 2 * pi * 25'000 / 1500;
  struct Ray {
    double pressure, phase_rad, sine;
  };
  constexpr std::array<Ray, 3> kRays{{{1, 0, 0.0044}, {0.728, pi - 0.7, 0.0172}, {0.605, pi - 0.3, -0.0128}}};
  SteadyBand band(receiver(), {23'000, 23'000 + kBandwidthHz});
  for (const Ray& ray : kRays) band.add({ray.pressure, ray.phase_rad, 0, ray.sine, -ray.sine});
  double mean = 0, square = 0;
  constexpr int kEnds = 200'000;
  for (int i = 0; i < kEnds; ++i) {
    const auto jitter_m = [&](std::uint64_t end) {
      return kPlatformJitterM *
             normal_at(
                 {.seed = 3, .who = static_cast<std::uint32_t>(end), .which = static_cast<std::uint64_t>(i)});
    };
    const double turn = kWaveNumber * (jitter_m(0) - jitter_m(1));
    std::complex<double> sum;
    for (const Ray& ray : kRays) sum += std::polar(ray.pressure, ray.phase_rad + turn * ray.sine);
    mean += std::norm(sum) / kEnds;
    square += std::norm(sum) * std::norm(sum) / kEnds;
  }
  const double deviation = std::sqrt(square - mean * mean);
  EXPECT_LT(deviation, mean / 4);
  EXPECT_NEAR(std::sqrt(band.jitter_variance()), deviation, deviation / 4);
}

}  // namespace
}  // namespace halocline::acoustics
