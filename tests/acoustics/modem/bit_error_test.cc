// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/modem/bit_error.h"

#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "acoustics/modem/error_model.h"
#include "core/check.h"
#include "tests/acoustics/reference_rows.h"
#include "tests/support/csv.h"

namespace halocline::acoustics {
namespace {

using testing::CsvRow;

PowerRatio ratio_of(const CsvRow& row) { return to_power_ratio(Decibels{row.number("EbN0_dB")}); }

RowFunction errors_of(Modulation modulation, Fading fading) {
  return [=](const CsvRow& row) { return bit_error_rate(modulation, fading, ratio_of(row)); };
}

RowFunction packets_of(Modulation modulation, Fading fading, std::int64_t bits) {
  return [=](const CsvRow& row) {
    return packet_error_rate(bit_error_rate(modulation, fading, ratio_of(row)), bits);
  };
}

TEST(BitError, EveryModulationMatchesTheReference) {
  const std::string file = "ber_per_uncoded.csv";
  expect_column(file, "BER_BPSK", errors_of(Modulation::kBpsk, Fading::kNone));
  expect_column(file, "BER_noncoh_BFSK", errors_of(Modulation::kNoncoherentBfsk, Fading::kNone));
  expect_column(file, "BER_coh_BFSK", errors_of(Modulation::kCoherentBfsk, Fading::kNone));
  expect_column(file, "BER_DBPSK", errors_of(Modulation::kDbpsk, Fading::kNone));
  expect_column(file, "BER_BPSK_Rayleigh", errors_of(Modulation::kBpsk, Fading::kRayleigh));
  expect_column(file, "BER_noncoh_BFSK_Rayleigh", errors_of(Modulation::kNoncoherentBfsk, Fading::kRayleigh));
}

TEST(BitError, PacketErrorsMatchTheReference) {
  const std::string file = "ber_per_uncoded.csv";
  for (const int bits : {64, 256, 2048}) {
    const std::string ending = "_" + std::to_string(bits) + "bit";
    expect_column(file, "PER_BPSK" + ending, packets_of(Modulation::kBpsk, Fading::kNone, bits));
    expect_column(file, "PER_ncBFSK" + ending, packets_of(Modulation::kNoncoherentBfsk, Fading::kNone, bits));
    expect_column(file, "PER_ncBFSK_Rayleigh" + ending,
                  packets_of(Modulation::kNoncoherentBfsk, Fading::kRayleigh, bits));
  }
}

// The two modulations no column has: the mean of the error without fading over exponential powers.
TEST(BitError, RayleighIsTheMeanOverExponentialPowers) {
  for (const Modulation modulation :
       {Modulation::kBpsk, Modulation::kDbpsk, Modulation::kCoherentBfsk, Modulation::kNoncoherentBfsk}) {
    const double mean = 3;
    double sum = 0;
    constexpr int kSteps = 200'000;  // u = sqrt(power / mean), midpoint rule over 0..8; its error is 1e-9
    constexpr double kStep = 8.0 / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      const double u = (i + 0.5) * kStep;
      sum += bit_error_rate(modulation, Fading::kNone, {mean * u * u}) * 2 * u * std::exp(-u * u) * kStep;
    }
    EXPECT_NEAR(sum, bit_error_rate(modulation, Fading::kRayleigh, {mean}), 1e-8);
  }
}

// Noise alone makes half of the bits right, but a pulse only by a false alarm of one in a thousand.
TEST(BitError, IsThatOfNoiseWithoutSignalAndZeroWithoutNoise) {
  for (const ErrorModel model : kErrorModels) {
    if (model == ErrorModel::kNone) continue;
    EXPECT_DOUBLE_EQ(bit_error_rate(model, {0}), model == ErrorModel::kPulses ? 0.999 : 0.5)
        << to_name(model);
    EXPECT_EQ(bit_error_rate(model, {std::numeric_limits<double>::infinity()}), 0) << to_name(model);
  }
}

// From 1e-6 to 1e9 in steps of 0.01 dB: never up, and down wherever the bound of a code is no cap, for a
// detector above the rounding of 1 - P.
TEST(BitError, FallsAsTheRatioRises) {
  for (const ErrorModel model : kErrorModels) {
    if (model == ErrorModel::kNone) continue;
    double before = bit_error_rate(model, {0});
    for (int step = -6000; step <= 9000; ++step) {
      const double now = bit_error_rate(model, to_power_ratio(Decibels{step * 0.01}));
      ASSERT_LE(now, before) << to_name(model) << " at " << step * 0.01 << " dB";
      if (before < 0.5 && before > (model == ErrorModel::kPulses ? 1e-13 : 1e-290)) {
        ASSERT_LT(now, before) << to_name(model) << " at " << step * 0.01;
      }
      before = now;
    }
  }
}

TEST(BitError, EveryErrorModelHasItsOwnName) {
  std::set<std::string_view> names;
  for (const ErrorModel model : kErrorModels) names.insert(to_name(model));
  EXPECT_EQ(names.size(), kErrorModels.size());
}

TEST(BitError, RefusesWhatIsNoRatioAndNoProbability) {
  EXPECT_THROW(bit_error_rate(Modulation::kBpsk, Fading::kNone, {-1}), InvalidArgument);
  EXPECT_THROW(bit_error_rate(Modulation::kBpsk, Fading::kNone, {std::nan("")}), InvalidArgument);
  EXPECT_THROW(packet_error_rate(1.1, 8), InvalidArgument);
  EXPECT_THROW(packet_error_rate(0.1, -1), InvalidArgument);
}

TEST(BitError, APacketOfNoBitsIsNeverWrong) {
  EXPECT_EQ(packet_error_rate(0.5, 0), 0);
  EXPECT_EQ(packet_error_rate(1, 0), 0);
  EXPECT_EQ(packet_error_rate(1, 1), 1);
}

}  // namespace
}  // namespace halocline::acoustics
