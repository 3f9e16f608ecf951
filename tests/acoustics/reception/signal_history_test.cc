// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/reception/signal_history.h"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/modem/error_model.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

constexpr Band kBand{22'500, 27'500};
constexpr ReceivedTiming kTiming{0.2, 2.2};

SignalHistory history_of(const FadingModel& model, const std::vector<Arrival>& paths, const Modem& modem,
                         std::uint32_t pair = 1) {
  return signal_history(model, {.seed = 1, .lower_id = pair, .higher_id = 9999}, 1, paths,
                        {&modem, best_window(paths, modem)}, kBand, SimTime::from_seconds(100), kTiming);
}

TEST(SignalHistory, WithoutFadingHasTheWindowsPowerAndEachEchoDuringItsInterval) {
  const Modem modem;
  const std::vector<Arrival> paths{{{.delay_s = 1}, {0}}, {{.delay_s = 1.05}, {-10}}};
  const SignalHistory history = history_of({}, paths, modem);
  EXPECT_EQ(history.frequencies, 1u);
  ASSERT_EQ(history.edges_s.size(), 4u);
  EXPECT_NEAR(history.edges_s[1], 0.05, 1e-12);  // the echo begins within the preamble
  EXPECT_EQ(history.signal, (std::vector<double>{1, 1, 1}));
  EXPECT_EQ(history.echoes[0], 0);
  EXPECT_NEAR(history.echoes[1], 0.1, 1e-12);
  EXPECT_NEAR(history.echoes[2], 0.1, 1e-12);
}

TEST(SignalHistory, OfASteadyPathIsItsPowerAtEveryTimeAndFrequency) {
  const FadingModel model{.enabled = true, .large_scale_db = 0};
  const SignalHistory history = history_of(model, {{{.delay_s = 1}, {3}}}, Modem());
  EXPECT_EQ(history.frequencies, 8u);
  EXPECT_GE(history.stretches(), 9u);
  for (const double s : history.signal) EXPECT_NEAR(to_decibels({s}).value, 3, 1e-9);
}

// |1 + g e^(-j 2 pi f tau)|^2 of two steady paths.
TEST(SignalHistory, TwoSteadyPathsMakeAComb) {
  const FadingModel model{.enabled = true};
  const double tau_s = 0.3e-3;
  const SignalHistory history =
      history_of(model, {{{.delay_s = 1}, {0}}, {{.delay_s = 1 + tau_s}, {-6}}}, Modem());
  const double g = std::pow(10, -0.3);
  for (std::size_t m = 0; m < 8; ++m) {
    const double f = kBand.low_hz + (static_cast<double>(m) + 0.5) * kBand.width_hz() / 8;
    const double expected = 1 + g * g + 2 * g * std::cos(2 * std::numbers::pi * f * tau_s);
    EXPECT_NEAR(history.signal[m], expected, 1e-6);
  }
}

// At these delays the 8 frequencies of one stretch are in step, not those of 8 stretches.
TEST(SignalHistory, NoDelayIsInStepThroughAHoppingPacket) {
  Modem modem;
  modem.error_model = ErrorModel::kJanus;
  const double g = std::pow(10, -0.3);
  for (int k = 1; k < 7; ++k) {
    const SignalHistory history =
        history_of({.enabled = true}, {{{.delay_s = 1}, {0}}, {{.delay_s = 1 + k / 625.0}, {-6}}}, modem);
    double mean = 0;
    for (std::size_t i = history.stretches() - 8; i < history.stretches(); ++i)
      mean += history.mean_signal(i) / 8;
    EXPECT_NEAR(mean, 1 + g * g, 1e-6) << k;
  }
}

// 1 + g^2 + 2 g cos(2 pi f_c tau) sin(pi B tau) / (pi B tau).
TEST(SignalHistory, PhaseShiftKeyingCollectsTheWholeBand) {
  Modem modem;
  modem.error_model = ErrorModel::kBpsk;
  const double g = std::pow(10, -0.3);
  for (const double tau_s : {0.01e-3, 0.1e-3, 0.33e-3, 1.6e-3, 7.1e-3}) {
    const SignalHistory history =
        history_of({.enabled = true}, {{{.delay_s = 1}, {0}}, {{.delay_s = 1 + tau_s}, {-6}}}, modem);
    const double x = std::numbers::pi * kBand.width_hz() * tau_s;
    const double expected =
        1 + g * g + 2 * g * std::cos(2 * std::numbers::pi * kBand.centre_hz() * tau_s) * std::sin(x) / x;
    EXPECT_EQ(history.frequencies, 1u);
    EXPECT_NEAR(history.signal[0], expected, 1e-6) << tau_s;
  }
}

TEST(SignalHistory, StretchesAreAQuarterOfTheCoherenceTimeWithin8To64) {
  const FadingModel model{.enabled = true};
  const auto stretches = [&](double spread_hz) {
    Arrival path{{.delay_s = 1}, {0}};
    path.fading = {0, 0, 1, spread_hz};
    return history_of(model, {path}, Modem()).stretches();
  };
  EXPECT_EQ(stretches(0.01), 1u + 8);
  // Coherence 1 / (sqrt(2) pi B) = 0.1125 s at 2 Hz: 72 quarters in 2 s, 8 in the preamble.
  EXPECT_EQ(stretches(2), 8u + 64);
  EXPECT_EQ(stretches(0.5), 2u + 18);
}

TEST(SignalHistory, PhaseShiftKeyingLosesWhatItDoesNotFollow) {
  const FadingModel model{.enabled = true, .large_scale_db = 0};
  Modem psk;
  psk.error_model = ErrorModel::kBpsk;
  Arrival path{{.delay_s = 1}, {0}};
  path.fading = {0, 0, 1, 2};
  double signal = 0, echoes = 0;
  const int links = 300;
  std::size_t stretches = 0;
  for (std::uint32_t pair = 0; pair < links; ++pair) {
    const SignalHistory history = history_of(model, {path}, psk, pair);
    EXPECT_EQ(history.frequencies, 1u);
    for (std::size_t i = 0; i < history.stretches(); ++i) {
      signal += history.signal[i];
      echoes += history.echoes[i];
      ++stretches;
    }
  }
  const double rho = std::exp(-std::pow(2 * std::numbers::pi * 2 * 0.05, 2) / 2);
  EXPECT_NEAR(signal / (signal + echoes), rho, 1e-9);
  EXPECT_NEAR((signal + echoes) / static_cast<double>(stretches), 1, 0.05);
}

TEST(SignalHistory, AResidualDopplerShiftCostsFrequencyShiftKeyingBySincSquared) {
  const FadingModel model{.enabled = true, .large_scale_db = 0};
  Modem modem;
  modem.chip = SimDuration::from_milliseconds(6);
  modem.doppler_correction = 0.001;
  const double residual = 0.0016;  // 40 Hz at 25 kHz
  const Arrival path{{.delay_s = 1}, {0}, 1.001 + residual};
  const SignalHistory history =
      shifted_history(history_of(model, {path}, modem), doppler_share(modem, path, 25'000));
  const double x = std::numbers::pi * 25'000 * residual * 0.006, share = std::pow(std::sin(x) / x, 2);
  EXPECT_NEAR(history.signal[0], share, 1e-9);
  EXPECT_NEAR(history.echoes[0], 1 - share, 1e-9);
}

}  // namespace
}  // namespace halocline::acoustics
