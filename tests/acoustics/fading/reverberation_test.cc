// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/fading/reverberation.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "core/check.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

constexpr Duct kShallow{.depth_m = 2.5, .trapped_share = 0.28};
constexpr Reverberation kLambert{.enabled = true};

// A direct path and one with four bounces.
std::vector<Arrival> two_paths() {
  return {{{.delay_s = 0.2}, {100}, 1, {.doppler_spread_hz = 0.1}},
          {{.delay_s = 0.203, .surface_bounces = 2, .bottom_bounces = 2}, {94}, 1, {.doppler_spread_hz = 2}}};
}

double tail_power(const std::vector<Arrival>& paths, double after_s = 0) {
  double sum = 0;
  for (const Arrival& path : paths) {
    if (is_reverberation(path) && path.delay_s >= after_s) sum += to_power_ratio(path.level).value;
  }
  return sum;
}

// Mackenzie's -27 dB scatters pi 10^-2.7 = 0.00627 of a bounce's power.
double fed() {
  return to_power_ratio(Decibels{94}).value * 0.28 * std::numbers::pi * (2 * std::pow(10, -2.7) + 2e-4);
}

TEST(Reverberation, HoldsThePowerOfItsClosedForm) {
  const double x = tail_decay_per_s(kLambert, kShallow) * 0.2;
  EXPECT_NEAR(tail_power(with_reverberation(kLambert, kShallow, two_paths())) /
                  (fed() * std::exp(x) * std::cyl_bessel_k(0, x)),
              1, 2e-3);  // of the power beyond 30 dB of decay: 1e-3 / x
}

// Lambert's angles below the critical one meet the bottom 1500 (2/3) sqrt(0.28) / 5 = 105.8 times a second: 1
// dB each.
TEST(Reverberation, DecaysByTheStatedLossAtEachBounce) {
  EXPECT_NEAR(tail_decay_per_s(kLambert, kShallow) * 10 / std::numbers::ln10, 105.83, 0.01);
  // dI/dt = R exp(-b s) / sqrt(t^2 - t0^2) from 0.23 s on, by steps of 1 us.
  const double begin_s = 0.2, rate = tail_decay_per_s(kLambert, kShallow);
  const auto paths = with_reverberation(kLambert, kShallow, two_paths());
  const Arrival& one = paths[paths.size() - 6];
  const double half_way_s = (one.delay_s + paths[paths.size() - 7].delay_s) / 2, step_s = 1e-6;
  double expected = 0;
  for (double t = half_way_s + step_s / 2; t < 1; t += step_s) {
    expected += fed() * std::exp(-rate * (t - begin_s)) / std::sqrt(t * t - begin_s * begin_s) * step_s;
  }
  EXPECT_NEAR(tail_power(paths, half_way_s) / expected, 1, 0.05);
}

TEST(Reverberation, IsScatteredSoundInTheOrderOfDelays) {
  const auto paths = with_reverberation(kLambert, kShallow, two_paths());
  ASSERT_EQ(paths.size(), 2 + kTailPaths);
  for (std::size_t i = 1; i < paths.size(); ++i) EXPECT_GE(paths[i].delay_s, paths[i - 1].delay_s);
  EXPECT_FALSE(is_reverberation(paths.front()));
  EXPECT_TRUE(is_reverberation(paths.back()));
  EXPECT_EQ(paths.back().fading.scattered, 1);
  EXPECT_EQ(paths.back().fading.doppler_spread_hz, 2);
}

TEST(Reverberation, NeedsBouncesAndABottomThatHoldsIt) {
  EXPECT_EQ(with_reverberation({}, kShallow, two_paths()).size(), 2u);
  EXPECT_EQ(with_reverberation(kLambert, {2.5, 0}, two_paths()).size(), 2u);
  EXPECT_EQ(with_reverberation(kLambert, kShallow, {two_paths().front()}).size(), 1u);
}

TEST(Reverberation, ImpossibleStrengthsAreRefused) {
  EXPECT_THROW(validate(Reverberation{.bottom_scattering_db = 0}), InvalidArgument);
  EXPECT_THROW(validate(Reverberation{.bounce_loss_db = 0}), InvalidArgument);
}

}  // namespace
}  // namespace halocline::acoustics
