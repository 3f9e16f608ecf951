// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/modem/convolutional_code.h"

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "core/check.h"
#include "tests/acoustics/modem/simulated_viterbi.h"
#include "tests/acoustics/reference_rows.h"
#include "tests/support/csv.h"

namespace halocline::acoustics {
namespace {

using testing::CsvRow;

TEST(ConvolutionalCode, JanusSpectrumMatchesTheReferenceExactly) {
  const auto rows = testing::read_reference_csv("acoustics/conv_code_753_561_spectrum.csv");
  ASSERT_EQ(janus_spectrum().size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(janus_spectrum()[i].distance, rows[i].number("d"));
    EXPECT_EQ(janus_spectrum()[i].paths, rows[i].number("a_d_paths"));
    EXPECT_EQ(janus_spectrum()[i].information_ones, rows[i].number("B_d_total_info_weight"));
    EXPECT_EQ(janus_spectrum()[i].information_ones, rows[i].number("B_d_ns3"));
  }
}

// The textbook code (7, 5): transfer function D^5 N / (1 - 2 D N), so a_d = 2^(d-5), B_d = (d-4) 2^(d-5).
TEST(ConvolutionalCode, TextbookSpectrumHasItsClosedForm) {
  const auto spectrum = distance_spectrum({3, {07, 05}}, 30);
  ASSERT_EQ(spectrum.size(), 26u);
  for (const SpectrumTerm& term : spectrum) {
    const double paths = std::ldexp(1, term.distance - 5);
    EXPECT_EQ(term, (SpectrumTerm{term.distance, paths, (term.distance - 4) * paths}));
  }
}

TEST(ConvolutionalCode, RefusesACatastrophicCode) {
  EXPECT_THROW(distance_spectrum({3, {03, 05}}, 12), InvalidArgument);  // both hold 1 + D
  EXPECT_THROW(distance_spectrum({3, {0, 05}}, 12), InvalidArgument);
  EXPECT_THROW(distance_spectrum({3, {010, 05}}, 12), InvalidArgument);
}

RowFunction bound_of(Decision decision, Fading fading) {
  return [=](const CsvRow& row) {
    return union_bound(janus_spectrum(), decision, fading,
                       to_power_ratio(Decibels{row.number("chip_SNR_dB")}));
  };
}

RowFunction packets_of(Decision decision, Fading fading) {
  return [=](const CsvRow& row) {
    const PowerRatio snr = to_power_ratio(Decibels{row.number("chip_SNR_dB")});
    return packet_error_rate(coded_bit_error_rate(janus_spectrum(), decision, fading, snr), 64);
  };
}

TEST(ConvolutionalCode, UnionBoundsMatchTheReference) {
  const std::string file = "per_janus_like_conv_union_bound.csv";
  expect_column(file, "Pb_union_soft_Rayleigh", bound_of(Decision::kSoft, Fading::kRayleigh));
  expect_column(file, "Pb_union_soft_AWGN_noncoh", bound_of(Decision::kSoft, Fading::kNone));
  expect_column(file, "Pb_union_hard_AWGN", bound_of(Decision::kHard, Fading::kNone));
  expect_column(file, "Pb_union_hard_Rayleigh", bound_of(Decision::kHard, Fading::kRayleigh));
}

TEST(ConvolutionalCode, PacketErrorsMatchTheReference) {
  const std::string file = "per_janus_like_conv_union_bound.csv";
  expect_column(file, "PER64_soft_Rayleigh", packets_of(Decision::kSoft, Fading::kRayleigh));
  expect_column(file, "PER64_soft_AWGN", packets_of(Decision::kSoft, Fading::kNone));
  expect_column(file, "PER64_hard_AWGN", packets_of(Decision::kHard, Fading::kNone));
  expect_column(file, "PER64_hard_Rayleigh", packets_of(Decision::kHard, Fading::kRayleigh));
}

TEST(ConvolutionalCode, SoftDecisionsBeatHardOnes) {
  for (int db = 0; db <= 16; ++db) {
    for (const Fading fading : {Fading::kNone, Fading::kRayleigh}) {
      const PowerRatio snr = to_power_ratio(Decibels{static_cast<double>(db)});
      EXPECT_LT(union_bound(janus_spectrum(), Decision::kSoft, fading, snr),
                union_bound(janus_spectrum(), Decision::kHard, fading, snr));
    }
  }
}

// The header's words on where nine terms are enough.
TEST(ConvolutionalCode, TheTenthTermAddsLessThanAThousandthFromSevenDecibels) {
  const auto ten = distance_spectrum(kJanusCode, 30);
  ASSERT_EQ(ten.size(), 10u);
  const PowerRatio snr = to_power_ratio(Decibels{7});
  const double nine = union_bound(janus_spectrum(), Decision::kSoft, Fading::kNone, snr);
  EXPECT_LT(union_bound(ten, Decision::kSoft, Fading::kNone, snr) - nine, 1e-3 * nine);
}

TEST(ConvolutionalCode, AProbabilityIsAtMostAGuess) {
  EXPECT_GT(union_bound(janus_spectrum(), Decision::kSoft, Fading::kNone, {1}), 1);
  EXPECT_EQ(coded_bit_error_rate(janus_spectrum(), Decision::kSoft, Fading::kNone, {1}), 0.5);
  EXPECT_EQ(union_bound(janus_spectrum(), Decision::kSoft, Fading::kNone,
                        {std::numeric_limits<double>::infinity()}),
            0);
}

double block_error_rate(double events, double bits) { return 1 - std::pow(1 - events, bits); }

PowerRatio ratio(double db) { return to_power_ratio(Decibels{db}); }

// Expects the `measured` share of `blocks` within 0.3 dB of the curve, with 99.9 % confidence: by the curve
// 0.3 dB on either side, and 3.3 standard deviations of the count there.
template <typename Curve>
void expect_within(double measured, int blocks, double db, const Curve& curve) {
  const double high = curve(db - 0.3), low = curve(db + 0.3);
  const auto deviation = [&](double rate) { return 3.3 * std::sqrt(rate * (1 - rate) / blocks); };
  EXPECT_LT(measured, high + deviation(high)) << db;
  EXPECT_GT(measured, low - deviation(low)) << db;
}

TEST(JanusErrorEvents, AreThoseOfASimulatedViterbiDecoderInWhiteNoise) {
  SimulatedViterbi receiver(1);
  const auto curve = [](double db) { return block_error_rate(janus_error_events(ratio(db)), 64); };
  EXPECT_NEAR(curve(3.35), 0.5, 0.03);
  EXPECT_NEAR(curve(5.05), 0.01, 0.003);
  for (const double db : {3.0, 3.35, 4.0, 4.5, 5.0}) {
    const int blocks = db < 4.2 ? 500 : 1500;
    expect_within(receiver.block_error_rate(ratio(db).value, 64, blocks, false), blocks, db, curve);
  }
}

TEST(JanusErrorEvents, OfLongBlocksAreIndependent) {
  SimulatedViterbi receiver(2);
  const auto curve = [](double db) { return block_error_rate(janus_error_events(ratio(db)), 256); };
  for (const double db : {4.0, 4.5}) {
    expect_within(receiver.block_error_rate(ratio(db).value, 256, 250, false), 250, db, curve);
  }
}

TEST(JanusErrorEvents, AreThoseOfASimulatedViterbiDecoderInRayleighFading) {
  SimulatedViterbi receiver(3);
  const auto curve = [](double db) { return block_error_rate(janus_error_events_rayleigh(ratio(db)), 64); };
  for (const double db : {5.2, 6.0, 7.0}) {
    expect_within(receiver.block_error_rate(ratio(db).value, 64, 700, true), 700, db, curve);
  }
}

TEST(JanusErrorEvents, FallFromAGuessWithoutASteepStepTowardsTheUnionBound) {
  EXPECT_EQ(janus_error_events({0}), 0.5);
  EXPECT_EQ(janus_error_events_rayleigh({0}), 0.5);
  EXPECT_EQ(janus_error_events({std::numeric_limits<double>::infinity()}), 0);
  double last = 0.5;
  for (double db = -20; db < 7; db += 0.05) {
    const double events = janus_error_events(ratio(db));
    EXPECT_LE(events, last) << db;
    EXPECT_GE(events, 0.7 * last) << db;
    EXPECT_LE(events, coded_bit_error_rate(janus_spectrum(), Decision::kSoft, Fading::kNone, ratio(db)))
        << db;
    last = events;
  }
}

}  // namespace
}  // namespace halocline::acoustics
