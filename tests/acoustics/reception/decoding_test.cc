// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/reception/decoding.h"

#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/modem/error_model.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

Modem modem_with(ErrorModel model) {
  Modem modem;
  modem.error_model = model;
  return modem;
}

// sinr in the band for an Eb/N0.
double sinr_of(const Modem& modem, double eb_over_n0_db) {
  return std::pow(10, eb_over_n0_db / 10) * modem.bit_rate_bps / modem.bandwidth_hz;
}

TEST(BlockDecoder, OfAConstantRatioIsThePowerOfTheBitErrorRate) {
  for (const ErrorModel model : {ErrorModel::kBfsk, ErrorModel::kBpsk, ErrorModel::kJanus}) {
    for (const bool fades : {false, true}) {
      const Modem modem = modem_with(model);
      BlockDecoder block(modem, fades);
      for (const double share : {0.3, 0.5, 0.2}) block.add(share, sinr_of(modem, 8.5));
      const double error = bit_error_rate(model, to_power_ratio(Decibels{8.5}));
      EXPECT_NEAR(block.success(200), std::pow(1 - error, 200), 1e-9) << to_name(model) << fades;
    }
  }
}

TEST(BlockDecoder, OfBitsThatFadeTogetherIsTheProductOverTheirCells) {
  const Modem modem = modem_with(ErrorModel::kBpsk);
  BlockDecoder block(modem, true);
  block.add(0.25, sinr_of(modem, 4));
  block.add(0.75, sinr_of(modem, 7));
  const double low = bit_error_rate(ErrorModel::kBpsk, to_power_ratio(Decibels{4}));
  const double high = bit_error_rate(ErrorModel::kBpsk, to_power_ratio(Decibels{7}));
  EXPECT_NEAR(block.success(100), std::pow(1 - low, 25) * std::pow(1 - high, 75), 1e-12);
}

// Chips in fast Rayleigh fading, 4000 strata of their exponential distribution: the effective ratio lands on
// the code's own curve for it, to 0.1 dB between bit error rates of 1e-2 and 3e-5.
TEST(BlockDecoder, LandsOnTheRayleighCurveOfTheJanusCode) {
  const Modem modem = modem_with(ErrorModel::kJanus);
  for (const double mean_db : {10.6, 11.3, 12.0, 12.3}) {  // Eb/N0
    BlockDecoder block(modem, true);
    const int cells = 4000;
    for (int i = 0; i < cells; ++i) {
      block.add(1.0 / cells, -std::log(1 - (i + 0.5) / cells) * sinr_of(modem, mean_db));
    }
    const double error = 1 - block.success(1);
    const double worse = bit_error_rate(ErrorModel::kJanusRayleigh, to_power_ratio(Decibels{mean_db - 0.1}));
    const double better = bit_error_rate(ErrorModel::kJanusRayleigh, to_power_ratio(Decibels{mean_db + 0.1}));
    EXPECT_LT(error, worse) << mean_db;
    EXPECT_GT(error, better) << mean_db;
  }
}

TEST(BlockDecoder, ALoudBlockIsRight) {
  const Modem modem = modem_with(ErrorModel::kJanus);
  BlockDecoder block(modem, true);
  block.add(1, 1e6);
  EXPECT_EQ(block.success(1000), 1);
}

}  // namespace
}  // namespace halocline::acoustics
