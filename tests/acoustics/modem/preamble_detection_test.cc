// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/modem/preamble_detection.h"

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "core/check.h"
#include "core/random.h"

namespace halocline::acoustics {
namespace {

TEST(PreambleDetection, OnePieceHasARayleighThreshold) {
  for (const double false_alarm : {1e-2, 1e-8, 1e-15}) {
    EXPECT_NEAR(detection_threshold(1, false_alarm), -std::log(false_alarm), 1e-9);
  }
}

TEST(PreambleDetection, WithoutSignalItIsTheFalseAlarm) {
  for (const int pieces : {1, 8, 32, 256}) {
    EXPECT_NEAR(detection_probability(pieces, 1e-3, {0}), 1e-3, 1e-12);
  }
}

// Marcum's Q of order 1 by its integral, midpoint rule.
TEST(PreambleDetection, OnePieceIsMarcumsQ) {
  const double h = 12, threshold = -std::log(1e-6), a = std::sqrt(2 * h), b = std::sqrt(2 * threshold);
  double below = 0;
  constexpr int kSteps = 20'000;  // the rule's error is 1e-9
  for (int i = 0; i < kSteps; ++i) {
    const double x = (i + 0.5) * b / kSteps;
    below += x * std::exp(-(x * x + a * a) / 2) * std::cyl_bessel_i(0, a * x) * b / kSteps;
  }
  EXPECT_NEAR(detection_probability(1, 1e-6, {h}), 1 - below, 1e-8);
}

// Pieces of complex noise plus a signal, squared and added; 20 000 trials, 4 standard deviations.
TEST(PreambleDetection, ManyPiecesMatchSimulatedReceivers) {
  constexpr int kPieces = 32, kTrials = 20'000;
  const double h = 30, half_threshold = detection_threshold(kPieces, 1e-4);
  int noticed = 0;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    double energy = 0;  // of unit-variance parts: twice the half
    for (std::uint32_t piece = 0; piece < kPieces; ++piece) {
      const DrawAddress in_phase{7, purpose_of("in-phase"), piece, trial};
      const DrawAddress quadrature{7, purpose_of("quadrature"), piece, trial};
      const double i = normal_at(in_phase) + std::sqrt(2 * h / kPieces), q = normal_at(quadrature);
      energy += i * i + q * q;
    }
    noticed += energy > 2 * half_threshold;
  }
  const double expected = detection_probability(kPieces, 1e-4, {h});
  EXPECT_GT(expected, 0.2);  // neither always nor never, or the comparison would prove nothing
  EXPECT_LT(expected, 0.8);
  EXPECT_NEAR(noticed / double{kTrials}, expected, 4 * std::sqrt(expected * (1 - expected) / kTrials));
}

TEST(PreambleDetection, RisesWithEnergyToOne) {
  for (const int pieces : {1, 32}) {
    double before = 0;
    for (int step = 0; step <= 800; ++step) {
      const double now = detection_probability(pieces, 1e-8, to_power_ratio(Decibels{step * 0.1 - 20}));
      ASSERT_GE(now, before) << step;
      before = now;
    }
    EXPECT_EQ(before, 1);
  }
  EXPECT_EQ(detection_probability(32, 1e-8, {1e12}), 1);
}

TEST(PreambleDetection, AddingPiecesWithoutPhaseCostsSensitivity) {
  EXPECT_LT(detection_probability(32, 1e-8, {30}), detection_probability(1, 1e-8, {30}));
}

TEST(PreambleDetection, RefusesImpossibleValues) {
  EXPECT_THROW(detection_threshold(0, 1e-8), InvalidArgument);
  EXPECT_THROW(detection_threshold(1, 0), InvalidArgument);
  EXPECT_THROW(detection_probability(1, 1e-8, {-1}), InvalidArgument);
}

}  // namespace
}  // namespace halocline::acoustics
