// SPDX-License-Identifier: BSD-3-Clause
// Waveforms against closed forms: tones through delays that stand still and move, noise against its spectrum.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/waveform/analytic_signal.h"
#include "acoustics/waveform/linear_phase_filter.h"
#include "acoustics/waveform/moving_link.h"
#include "acoustics/waveform/shaped_noise.h"
#include "core/check.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;
constexpr double kRate = 96'000;

std::vector<double> tone(double frequency_hz, double seconds) {
  std::vector<double> samples(static_cast<std::size_t>(seconds * kRate));
  for (std::size_t n = 0; n < samples.size(); ++n)
    samples[n] = std::cos(2 * pi * frequency_hz * static_cast<double>(n) / kRate);
  return samples;
}

// What arrives of a tone at 0 between two ends of the recording.
Samples received_of(const MovingLink& link, double frequency_hz, double begin_s, double end_s) {
  Samples received{begin_s, kRate, std::vector<double>(static_cast<std::size_t>((end_s - begin_s) * kRate))};
  link.add_received({kRate, tone(frequency_hz, 1)}, 0, received);
  return received;
}

double time_of(const Samples& samples, std::size_t n) {
  return samples.begin_s + static_cast<double>(n) / samples.rate_hz;
}

TEST(AnalyticSignal, IsATurningToneBetweenSamples) {
  for (const double frequency_hz : {0.01 * kRate, 0.1 * kRate, 0.26 * kRate, 0.4 * kRate}) {
    const AnalyticSignal signal(kRate, tone(frequency_hz, 0.1));
    double worst = 0;
    for (int i = 0; i < 2000; ++i) {
      const double at_s = 0.03 + 0.04 * i / 2000.0 + 1e-7 * i;
      worst = std::max(worst, std::abs(signal.at(at_s) - std::polar(1.0, 2 * pi * frequency_hz * at_s)));
    }
    EXPECT_LT(worst, 2e-4) << frequency_hz;
  }
}

TEST(AnalyticSignal, IsNothingOutsideItsSamples) {
  const AnalyticSignal signal(kRate, tone(9600, 0.01));
  EXPECT_EQ(signal.at(-0.001), 0.0);
  EXPECT_EQ(signal.at(0.011), 0.0);
  EXPECT_THROW(AnalyticSignal(0, {1}), InvalidArgument);
  EXPECT_THROW(AnalyticSignal(kRate, {NAN}), InvalidArgument);
}

// Half the pressure, turned by a quarter, 0.1234567 s later.
TEST(MovingLink, AStillPathDelaysAndTurns) {
  const double delay_s = 0.1234567, frequency_hz = 24'000;
  const std::vector<PathGain> paths{{1, delay_s, std::polar(0.5, pi / 2), 1}};
  const MovingLink link(-0.1, 0.3, {paths, paths, paths, paths, paths});
  EXPECT_EQ(link.longest_delay_s(), delay_s);
  const Samples received = received_of(link, frequency_hz, 0.3, 0.9);
  for (std::size_t n = 0; n < received.values.size(); n += 7) {
    const double expected = 0.5 * std::cos(2 * pi * frequency_hz * (time_of(received, n) - delay_s) + pi / 2);
    ASSERT_NEAR(received.values[n], expected, 1e-4) << n;
  }
}

// The receiver leaves at v, so what left at u arrives at u + (r + v (t - 0)) / c: t = (u + r / c) / (1 - v /
// c), tau = t - u, and the tone is heard at f (1 - v / c).
TEST(MovingLink, AMovingPathHasItsDopplerShift) {
  const double c = 1500, v = 3, r = 300, frequency_hz = 20'000, step_s = 0.02;
  std::vector<std::vector<PathGain>> frames;
  for (int k = 0; k < 60; ++k) {
    const double u = k * step_s;
    frames.push_back({{7, (u + r / c) / (1 - v / c) - u, 1.0, 1 - v / c}});
  }
  const Samples received = received_of({0, step_s, frames}, frequency_hz, 0.3, 1.1);
  for (std::size_t n = 0; n < received.values.size(); n += 5) {
    const double t = time_of(received, n);
    ASSERT_NEAR(received.values[n], std::cos(2 * pi * frequency_hz * (t * (1 - v / c) - r / c)), 2e-4) << n;
  }
}

TEST(MovingLink, PathsAddAndOneThatVanishesFallsToNothing) {
  const double step_s = 0.1, frequency_hz = 10'000;
  const PathGain stays{1, 0.1, 1.0, 1}, goes{2, 0.15, 0.5, 1};
  const Samples received = received_of({0, step_s, {{stays, goes}, {stays, goes}, {stays}, {stays}, {stays}}},
                                       frequency_hz, 0.16, 0.45);
  const auto cosine = [&](double t) { return std::cos(2 * pi * frequency_hz * t); };
  for (std::size_t n = 0; n < received.values.size(); n += 3) {
    const double t = time_of(received, n), left = t - 0.15;
    const double second = 0.5 * std::clamp((0.2 - left) / step_s, 0.0, 1.0);
    ASSERT_NEAR(received.values[n], cosine(t - 0.1) + second * cosine(left), 2e-4) << t;
  }
}

TEST(MovingLink, RefusesWhatIsNoLink) {
  EXPECT_THROW(MovingLink(0, 0.1, {{}}), InvalidArgument);
  EXPECT_THROW(MovingLink(0, 0, {{}, {}}), InvalidArgument);
  EXPECT_THROW(MovingLink(0, 0.1, {{{1, 0.5, 1.0, 1}}, {{1, 0.3, 1.0, 1}}}), InvalidArgument);
}

// Power in bands of 4 kHz, from 200 spectra of 5 ms by the formula of a discrete transform: the standard
// error of the mean of 200 * 20 exponential powers is 1.6 %.
TEST(LinearPhaseFilter, ChangesTheLevelOfATone) {
  const auto amplitude = [](double frequency_hz) { return 1 - frequency_hz / 1e5; };
  const std::vector<double> taps = linear_phase_taps(amplitude, kRate);
  for (const double frequency_hz : {5e3, 2e4}) {
    const std::vector<double> sent = tone(frequency_hz, 0.05);
    const std::vector<double> heard = filtered(sent, taps);
    for (std::size_t n = kFilterHalf; n + kFilterHalf < sent.size(); ++n)
      ASSERT_NEAR(heard[n], amplitude(frequency_hz) * sent[n], 1e-3) << n;  // the window is 63 dB down
  }
  EXPECT_THROW(linear_phase_taps([](double) { return -1.0; }, kRate), InvalidArgument);
  EXPECT_THROW(linear_phase_taps(amplitude, 0), InvalidArgument);
}

TEST(ShapedNoise, HasItsSpectrum) {
  const auto density = [](double f) { return 1e4 / (1 + std::pow(f / 10'000, 2)); };
  const ShapedNoise noise(density, kRate, {.seed = 3, .purpose = 4, .who = 5});
  constexpr int kLength = 480, kSpectra = 200;  // 5 ms: lines 200 Hz apart
  const std::vector<double> samples = noise.samples(1000, kLength * kSpectra);
  for (const int first : {20, 60, 120, 180}) {
    double measured = 0, stated = 0;
    for (int line = first; line < first + 20; ++line) {
      const double f = line * kRate / kLength;
      stated += density(f) / 20;
      for (int s = 0; s < kSpectra; ++s) {
        std::complex<double> sum = 0;
        for (int n = 0; n < kLength; ++n)
          sum += samples[static_cast<std::size_t>(s * kLength + n)] *
                 std::polar(1.0, -2 * pi * line * n / kLength);
        measured += 2 * std::norm(sum) / (kRate * kLength) / (20.0 * kSpectra);
      }
    }
    EXPECT_NEAR(measured / stated, 1, 4 * 0.016) << first;
  }
}

TEST(ShapedNoise, IsTheSameHoweverItIsCut) {
  const ShapedNoise noise([](double) { return 1.0; }, kRate, {.seed = 3});
  const std::vector<double> whole = noise.samples(-50, 300), part = noise.samples(100, 50);
  for (std::size_t n = 0; n < part.size(); ++n) EXPECT_EQ(part[n], whole[150 + n]) << n;
  const std::vector<double> louder = noise.samples(100, 50, [](std::int64_t) { return 2.0; });
  for (std::size_t n = 0; n < part.size(); ++n) EXPECT_NEAR(louder[n], 2 * part[n], 1e-9) << n;
  EXPECT_THROW(ShapedNoise([](double) { return -1.0; }, kRate, {}), InvalidArgument);
}

}  // namespace
}  // namespace halocline::acoustics
