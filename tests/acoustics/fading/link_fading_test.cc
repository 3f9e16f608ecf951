// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/fading/link_fading.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/random.h"
#include "core/units.h"
#include "tests/support/doc_table.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

constexpr Band kBand{22'500, 27'500};

FadingModel small_scale() { return {.enabled = true, .large_scale_db = 0}; }

Arrival path_of(double level_db, const PathFading& fading) {
  return {{.delay_s = 1, .identity = {.branch = 17}}, {level_db}, 1, fading};
}

std::complex<double> response(const FadingModel& model, const FadingLink& link, const Arrival& path,
                              double time_s) {
  return LinkFading(model, link).responses({path}, kBand, SimTime::from_seconds(time_s), {}, 1).front();
}

// Kolmogorov's distance times the root of n is above 1.95 with the chance 1e-3.
double kolmogorov(std::vector<double> samples, const std::function<double(double)>& distribution) {
  std::sort(samples.begin(), samples.end());
  const double n = static_cast<double>(samples.size());
  double distance = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double p = distribution(samples[i]);
    distance = std::max({distance, p - static_cast<double>(i) / n, static_cast<double>(i + 1) / n - p});
  }
  return distance * std::sqrt(n);
}

// Of the amplitude of a steady part of power c and complex Gaussian noise of power d: integral of Rice's
// density 2 r / d exp(-(r^2 + c) / d) I0(2 r sqrt(c) / d), by Simpson's rule.
double rice(double c, double d, double r) {
  constexpr int kSteps = 400;
  const auto density = [&](double x) {
    return 2 * x / d * std::exp(-(x * x + c) / d) * std::cyl_bessel_i(0, 2 * x * std::sqrt(c) / d);
  };
  double sum = density(0) + density(r);
  for (int i = 1; i < kSteps; ++i) sum += (i % 2 == 1 ? 4 : 2) * density(r * i / kSteps);
  return sum * r / kSteps / 3;
}

TEST(LinkFading, AmplitudesFollowRiceOverIndependentLinks) {
  for (const double steady : {0.0, 0.5, 0.9}) {
    std::vector<double> amplitudes;
    for (std::uint32_t pair = 1; pair <= 10'000; ++pair) {
      amplitudes.push_back(
          std::abs(response(small_scale(), {.seed = 5, .lower_id = pair, .higher_id = 20'000},
                            path_of(0, {steady, (1 - steady) / 3, (1 - steady) * 2 / 3, 0.7}), 123.456)));
    }
    const double distance = kolmogorov(amplitudes, [&](double r) { return rice(steady, 1 - steady, r); });
    EXPECT_LT(distance, 1.95) << "steady share " << steady;
    testing::doc_row(
        "fading",
        {fmt::format("root of n times Kolmogorov's distance to Rice's distribution, steady share {:.1f}",
                     steady),
         "< 1.95 (p > 1e-3)", fmt::format("{:.2f}", distance)});
  }
}

// Over 1e5 s a sum of sines has spent all its coherence times: the mean is that of the sines themselves.
TEST(LinkFading, MeanPowerOverADayIsThePowerOfThePath) {
  const Arrival path = path_of(20 * std::log10(3), {0.3, 0.2, 0.5, 1.3});
  const LinkFading fading(small_scale(), {.seed = 9, .lower_id = 1, .higher_id = 2});
  const int count = 200'000;
  double sum = 0;
  for (const auto& h : fading.responses({path}, kBand, SimTime(), {0, 0.5, count}, 1)) sum += std::norm(h);
  const double excess_db = to_decibels({sum / count / 9}).value;
  EXPECT_NEAR(excess_db, 0, 0.05);
  testing::doc_row("fading",
                   {"mean power over 1e5 s", "0.05 dB", fmt::format("{:.3f} dB", std::abs(excess_db))});
}

TEST(LinkFading, LargeScaleFadingLeavesTheMeanPowerAndHasItsDeviation) {
  const FadingModel model{.enabled = true};
  double power = 0, level = 0, squares = 0;
  const int links = 20'000;
  for (std::uint32_t pair = 0; pair < links; ++pair) {
    const double x = LinkFading(model, {.seed = 1, .lower_id = pair, .higher_id = 1})
                         .large_scale(SimTime::from_seconds(77));
    power += x * x / links;
    level += 20 * std::log10(x) / links;
    squares += std::pow(20 * std::log10(x), 2) / links;
  }
  // Power of a log-normal: relative deviation sqrt(exp((0.23 sigma)^2) - 1) = 0.78, of 20 000: 3.3 times
  // 0.0055.
  EXPECT_NEAR(power, 1, 0.019);
  EXPECT_NEAR(level, -1.036, 3.3 * 3 / std::sqrt(links));
  EXPECT_NEAR(std::sqrt(squares - level * level), 3, 3.3 * 3 / std::sqrt(2.0 * links));
}

// Mean over many paths of Re h(t) h*(t + tau); the chance deviation of 4000 is 0.016.
TEST(LinkFading, AutocorrelationOfWhatIsScatteredIsGaussianInItsSpread) {
  const double spread_hz = 2, lag_s = 1 / (std::numbers::sqrt2 * pi * spread_hz);
  double correlation = 0;
  const int links = 4000;
  for (std::uint32_t pair = 0; pair < links; ++pair) {
    const LinkFading fading(small_scale(), {.seed = 3, .lower_id = pair, .higher_id = 9999});
    const auto h = fading.responses({path_of(0, {0, 0, 1, spread_hz})}, kBand, SimTime(), {5, lag_s, 2}, 1);
    correlation += (h[0] * std::conj(h[1])).real() / links;
  }
  EXPECT_NEAR(correlation, std::exp(-1), 0.03);
  testing::doc_row(
      "fading", {"autocorrelation at 1 / (sqrt2 pi B)", "0.368 ± 0.03", fmt::format("{:.3f}", correlation)});
}

// Rice's formula: upward crossings of the level rho (re rms) a second, 2 sqrt(pi) B rho exp(-rho^2).
TEST(LinkFading, CrossesLevelsAsOftenAsRiceSays) {
  const double spread_hz = 1, step_s = 0.01;
  const int count = 100'000;
  for (const double rho : {0.3, 0.7, 1.0}) {
    int crossings = 0;
    double time_s = 0;
    for (std::uint32_t pair = 0; pair < 40; ++pair, time_s += count * step_s) {
      const LinkFading fading(small_scale(), {.seed = 8, .lower_id = pair, .higher_id = 9999});
      const auto h =
          fading.responses({path_of(0, {0, 0, 1, spread_hz})}, kBand, SimTime(), {0, step_s, count}, 1);
      for (std::size_t i = 1; i < h.size(); ++i)
        crossings += std::abs(h[i - 1]) < rho && std::abs(h[i]) >= rho;
    }
    const double expected = 2 * std::sqrt(pi) * spread_hz * rho * std::exp(-rho * rho);
    EXPECT_NEAR(crossings / time_s, expected, 0.05 * expected) << "level " << rho;
    testing::doc_row("fading",
                     {fmt::format("crossings of {:.1f} times the rms over those of Rice's formula", rho),
                      "1 ± 0.05", fmt::format("{:.3f}", crossings / time_s / expected)});
  }
}

TEST(LinkFading, BothDirectionsFadeAlike) {
  Arrival there = path_of(0, {0.2, 0.5, 0.3, 1}), back = there;
  there.launch_angle_rad = 0.1;
  there.arrival_angle_rad = -0.2;
  back.launch_angle_rad = 0.2;
  back.arrival_angle_rad = -0.1;
  FadingLink link{.seed = 4, .lower_id = 1, .higher_id = 2};
  const auto one = response(small_scale(), link, there, 50);
  link.reversed = true;
  EXPECT_EQ(one, response(small_scale(), link, back, 50));
}

TEST(LinkFading, AValueDoesNotDependOnTheStepItIsReachedBy) {
  const Arrival path = path_of(0, {0.2, 0.5, 0.3, 1});
  const LinkFading fading(small_scale(), {.seed = 4, .lower_id = 1, .higher_id = 2});
  const auto stepped = fading.responses({path}, kBand, SimTime::from_seconds(1e6), {0, 0.01, 64}, 1);
  const auto alone = fading.responses({path}, kBand, SimTime::from_seconds(1e6), {0.63, 1, 1}, 1);
  EXPECT_LT(std::abs(stepped.back() - alone.front()), 1e-9);
}

// Mean over links of the product of two paths' medium against its Gaussian of the distance.
TEST(LinkFading, PathsThroughTheSameWaterShareTheMedium) {
  const double apart_rad = to_radians(4);
  Arrival one = path_of(0, {0, 1, 0, 0.01}), other = one;
  other.arrival_angle_rad = apart_rad;
  std::complex<double> product = 0;
  const int links = 4000;
  for (std::uint32_t pair = 0; pair < links; ++pair) {
    const LinkFading fading(small_scale(), {.seed = 6, .lower_id = pair, .higher_id = 9999});
    const auto h = fading.responses({one, other}, kBand, SimTime(), {}, 1);
    product += h[0] * std::conj(h[1]) / static_cast<double>(links);
  }
  EXPECT_NEAR(product.real(), std::exp(-0.5), 4 / std::sqrt(links));
}

// Lloyd's mirror: direct path and one of opposite phase, with no roughness, over the band's middle.
TEST(MeanPower, OfSteadyPathsIsTheSquareOfTheirPressures) {
  const FadingModel model{.enabled = true, .rice_factor_db = 60};
  const PathFading steady = path_fading(model, 0, 25'000, 0, 0);
  const Arrival direct{{.delay_s = 1}, {0}, 1, steady};
  Arrival mirrored = direct;
  mirrored.phase_rad = pi;
  mirrored.delay_s += 1e-6;  // an eighth of a cycle in the middle, the same over the band
  const double expected = 4 * std::pow(std::sin(pi * 25'000 * 1e-6), 2);
  EXPECT_NEAR(mean_power(model, {direct, mirrored}, kBand), expected, 1e-3);
}

// A movement of 0.2 m leaves exp(-(k J)^2 dsin^2 / 2) of the interference, here of angles 0.03 rad to both
// sides at the receiver: k J = 20.94.
TEST(MeanPower, IsTheMeanOverTheMovementOfBothEnds) {
  FadingModel model{.enabled = true, .rice_factor_db = 60};
  const PathFading steady = path_fading(model, 0, 25'000, 0, 0);
  Arrival direct{{.delay_s = 1}, {0}, 1, steady};
  direct.arrival_angle_rad = 0.03;
  Arrival mirrored = direct;
  mirrored.arrival_angle_rad = -0.03;
  mirrored.phase_rad = pi;
  EXPECT_NEAR(mean_power(model, {direct, mirrored}, kBand), 0, 1e-5);
  model.platform_jitter_m = 0.2;
  const double turned = 2 * pi * 25'000 / 1500 * 0.2 * 2 * std::sin(0.03);
  const double expected = 2 - 2 * std::exp(-turned * turned / 2);
  EXPECT_NEAR(mean_power(model, {direct, mirrored}, kBand), expected, 1e-5);
}

// Near 20 dB within 0.8 m of depth are a few for a link whose ends move by 0.2 m.
TEST(MeanPower, VariesLittleOverDepthWhereTheEndsMove) {
  FadingModel model{.enabled = true, .rice_factor_db = 60};
  const PathFading steady = path_fading(model, 0, 25'000, 0, 0);
  const auto range_db = [&](double jitter_m) {
    model.platform_jitter_m = jitter_m;
    double least = 1e9, most = -1e9;
    for (double z = 0; z < 0.8; z += 0.01) {
      Arrival direct{{.delay_s = 1}, {0}, 1, steady}, mirrored = direct;
      direct.arrival_angle_rad = 0.02;
      mirrored.arrival_angle_rad = -0.02;
      mirrored.delay_s += 2 * z * std::sin(0.02) / 1500;
      mirrored.level = Decibels{-1};
      const double level_db = 10 * std::log10(mean_power(model, {direct, mirrored}, kBand));
      least = std::min(least, level_db);
      most = std::max(most, level_db);
    }
    return most - least;
  };
  EXPECT_GT(range_db(0), 18);
  EXPECT_LT(range_db(0.2), 10);
}

TEST(MeanPower, OfPathsFarApartIsTheSumOfTheirPowers) {
  const FadingModel model{.enabled = true};
  const PathFading fading = path_fading(model, 0, 25'000, 0, 0);
  const Arrival early{{.delay_s = 1}, {0}, 1, fading};
  Arrival late = early;
  late.delay_s += 100 / kBand.width_hz() + 0.2e-3;
  EXPECT_NEAR(mean_power(model, {early, late}, kBand), 2, 2 / (pi * 100));
}

// The mean over 4000 links and the band of |sum of responses|^2 is what mean_power says.
TEST(MeanPower, IsTheMeanOfWhatIsReceived) {
  const FadingModel model = small_scale();
  std::vector<Arrival> paths{
      {{.delay_s = 1, .identity = {.branch = 1}}, {0}, 1, {0.6, 0.3, 0.1, 0.5}},
      {{.delay_s = 1.00003, .phase_rad = pi, .identity = {.branch = 2}}, {-3}, 1, {0.3, 0.2, 0.5, 0.5}},
      {{.delay_s = 1.0002, .phase_rad = 1, .identity = {.branch = 3}}, {-1}, 1, {0.5, 0.5, 0, 0.1}}};
  const int links = 4000, frequencies = 32;
  double mean = 0;
  for (std::uint32_t pair = 0; pair < links; ++pair) {
    const LinkFading fading(model, {.seed = 2, .lower_id = pair, .higher_id = 9999});
    const auto h = fading.responses(paths, kBand, SimTime(), {}, 1);
    for (int m = 0; m < frequencies; ++m) {
      const double f = kBand.low_hz + (m + 0.5) * kBand.width_hz() / frequencies;
      std::complex<double> sum = 0;
      for (std::size_t p = 0; p < paths.size(); ++p)
        sum += h[p] * std::polar(1.0, -2 * pi * f * (paths[p].delay_s - 1));
      mean += std::norm(sum) / (links * frequencies);
    }
  }
  EXPECT_NEAR(mean / mean_power(model, paths, kBand), 1, 4 / std::sqrt(links));
}

}  // namespace
}  // namespace halocline::acoustics
