#include "acoustics/reception/steady_band.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "acoustics/math/frequency_band.h"
#include "acoustics/modem/modem.h"
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
  band.add(1, 0, 0);
  band.add(r, phase_rad, cycles / kBandwidthHz);
  return band;
}

TEST(SteadyBand, OnePathIsConstant) {
  SteadyBand band(receiver(), {23'000, 27'000});
  band.add(3, 1, 0.004);
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

}  // namespace
}  // namespace halocline::acoustics
