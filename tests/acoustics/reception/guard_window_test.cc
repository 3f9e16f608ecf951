// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/reception/guard_window.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

// 10 ms of guard, as much of taper.
Modem modem() { return {}; }

Arrival path_at(double delay_s, double level_db) { return {{.delay_s = delay_s}, {level_db}}; }

// Mean power that the window leaves to interfere: the sum of interference shares times P.
double mean_interference(const std::vector<Arrival>& paths, const GuardWindow& window) {
  double sum = 0;
  for (std::size_t i = 0; i < paths.size(); ++i)
    sum += window.shares[i].interference * to_power_ratio(paths[i].level).value;
  return sum;
}

double share_db(double power) { return to_decibels({power}).value; }

TEST(GuardWindow, LocksOnTheIntervalThatHoldsTheMostPowerNotOnAWeakPrecursor) {
  const std::vector<Arrival> paths{path_at(1, -15), path_at(1.1, 0), path_at(1.105, -3)};
  const GuardWindow window = best_window(paths, modem());
  EXPECT_EQ(window.first, 1u);
  EXPECT_EQ(window.strongest, 1u);
  EXPECT_EQ(window.shares[0].weight, 0);
  EXPECT_EQ(window.shares[1].weight, 1);
  EXPECT_EQ(window.shares[2].weight, 1);
  EXPECT_NEAR(mean_signal(paths, window), 1 + std::pow(10, -0.3), 1e-12);
  EXPECT_NEAR(mean_interference(paths, window), std::pow(10, -1.5), 1e-12);
}

TEST(GuardWindow, BeginsAtAPrecursorWithinTheGuardTime) {
  const std::vector<Arrival> paths{path_at(1, -15), path_at(1.008, 0)};
  const GuardWindow window = best_window(paths, modem());
  EXPECT_EQ(window.first, 0u);
  EXPECT_EQ(window.strongest, 1u);
  EXPECT_EQ(mean_interference(paths, window), 0);
}

// Delay windows of turned sound have equal powers but for rounding.
TEST(GuardWindow, TakesTheFirstOfEqualPowersWhateverTheLastDigit) {
  for (const double digit : {-1e-9, 0.0, 1e-9}) {
    const std::vector<Arrival> paths{path_at(1, 0), path_at(1.05, digit), path_at(1.1, -digit)};
    const GuardWindow window = best_window(paths, modem());
    EXPECT_EQ(window.first, 0u);
    EXPECT_EQ(window.strongest, 0u);
  }
}

TEST(GuardWindow, WeightsAnEchoByARaisedCosineAfterTheGuardTime) {
  for (const double late : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const std::vector<Arrival> paths{path_at(1, 0), path_at(1.010 + 0.010 * late, -10)};
    const double w = (1 + std::cos(std::numbers::pi * late)) / 2;
    const GuardWindow window = best_window(paths, modem());
    EXPECT_NEAR(window.shares[1].weight, w, 1e-9);
    EXPECT_NEAR(window.shares[1].interference, 1 - w * w, 1e-9);
  }
}

// Of two windows without a path in common the weaker one is as likely where both are equal, and never chosen
// 1 dB below.
TEST(GuardWindow, WeighsTwoWindowsOfNearlyTheSamePower) {
  for (const auto& [lower_db, likely] : {std::pair(0.0, 0.5), std::pair(0.5, 0.125)}) {
    const auto windows = likely_windows({path_at(1, -lower_db), path_at(1.1, 0)}, modem());
    ASSERT_EQ(windows.size(), 2u) << lower_db;
    const LikelyWindow& weaker = windows[lower_db > 0 || windows[1].window.first == 0 ? 1 : 0];
    EXPECT_NEAR(weaker.probability, likely, 1e-12);
    EXPECT_NEAR(windows[0].probability + windows[1].probability, 1, 1e-15);
  }
  EXPECT_EQ(likely_windows({path_at(1, -1.01), path_at(1.1, 0)}, modem()).size(), 1u);
  // The echo is part of both windows.
  EXPECT_EQ(likely_windows({path_at(1, -20), path_at(1.002, 0)}, modem()).size(), 1u);
}

// Shifting an echo by 15 us, 2 cm, anywhere around the window changes nothing by more than a hundredth.
TEST(GuardWindow, HasNoWall) {
  double last_signal = 0, last_interference = 0;
  for (int i = -2000; i <= 2000; ++i) {
    std::vector<Arrival> paths{path_at(1, 0), path_at(1 + 15e-6 * i, -1)};
    if (i < 0) std::swap(paths[0], paths[1]);
    const GuardWindow window = best_window(paths, modem());
    const double signal = mean_signal(paths, window), interference = mean_interference(paths, window);
    EXPECT_NEAR(signal + interference, 1 + std::pow(10, -0.1), 1e-12);
    if (i > -2000) {
      EXPECT_NEAR(signal, last_signal, 0.01) << i;
      EXPECT_NEAR(interference, last_interference, 0.01) << i;
    }
    last_signal = signal;
    last_interference = interference;
  }
}

TEST(GuardWindow, HoppingSparesAnEchoUntilThePatternReturns) {
  Modem hopping = modem();
  hopping.guard_time = SimDuration::from_milliseconds(3);
  hopping.chip = SimDuration::from_milliseconds(6);
  hopping.hop_count = 13;
  hopping.hop_clearing = SimDuration::from_milliseconds(72);
  const auto interference_after = [&](double echo_s) {
    const std::vector<Arrival> paths{path_at(1, 0), path_at(1 + echo_s, -6)};
    return mean_interference(paths, best_window(paths, hopping));
  };
  EXPECT_EQ(interference_after(0.02), 0);
  EXPECT_EQ(interference_after(0.072), 0);
  // One time in 13 all of it lies in one of two tones, which are 1 / 6 ms wide: B T / 26 as white noise.
  const double chip_widths = hopping.bandwidth_hz * 0.006;
  EXPECT_NEAR(share_db(interference_after(0.1)), -6 + 10 * std::log10(chip_widths / 26), 1e-9);
}

// Half a chip of the echo, whose tone is 1 / T away: |(1 / T) integral over T / 2 of e^(j 2 pi t / T)|^2.
TEST(GuardWindow, AnEchoThatEndsWithinAChipLeaksIntoTheOtherTone) {
  Modem hopping = modem();
  hopping.guard_time = SimDuration::from_milliseconds(3);
  hopping.chip = SimDuration::from_milliseconds(6);
  hopping.hop_count = 13;
  hopping.hop_clearing = SimDuration::from_milliseconds(72);
  const auto interference_after = [&](double echo_s) {
    const std::vector<Arrival> paths{path_at(1, 0), path_at(1 + echo_s, -6)};
    return mean_interference(paths, best_window(paths, hopping));
  };
  hopping.guard_taper = SimDuration::from_milliseconds(3);
  const double half_chip = std::pow(10, -0.6) * hopping.bandwidth_hz * 0.006 / std::pow(std::numbers::pi, 2);
  // 4.5 ms late its weight is 1/2, and sin^2(3 pi / 4) = 1/2.
  EXPECT_NEAR(interference_after(0.0045), 0.75 * half_chip / 2, 1e-6 * half_chip);
  EXPECT_EQ(interference_after(0.003), 0);
  // Seven pairs of tones in the same band lie 2 / T apart: sin^2(6 pi / 4) / (2 pi)^2 of its power leaks.
  hopping.hop_count = 7;
  EXPECT_NEAR(interference_after(0.0045), 0.75 * half_chip / 4, 1e-6 * half_chip);
}

TEST(GuardWindow, OfOnePathIsThatPath) {
  const std::vector<Arrival> paths{path_at(1, -3)};
  const GuardWindow window = best_window(paths, modem());
  EXPECT_EQ(window.first, 0u);
  EXPECT_NEAR(share_db(mean_signal(paths, window)), -3, 1e-12);
}

}  // namespace
}  // namespace halocline::acoustics
