// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/modem/half_delivery.h"

#include <cmath>

#include <gtest/gtest.h>

#include "acoustics/modem/error_model.h"
#include "core/check.h"
#include "core/sim_time.h"

namespace halocline::acoustics {
namespace {

// (1 - exp(-g / 2) / 2)^n = 1/2 at g = -2 ln(2 (1 - 2^(-1/n))), g = SINR B / R.
TEST(HalfDelivery, IsWhereAllBitsAreRightHalfTheTime) {
  const Modem modem = generic_modem(Decibels{185}, Decibels{70}, 25'000, 5'000);
  for (const std::size_t bytes : {1u, 32u, 1000u}) {
    const double bits = 8.0 * static_cast<double>(bytes);
    const double energy_ratio = -2 * std::log(2 * (1 - std::pow(2, -1 / bits)));
    const double expected_db = 10 * std::log10(energy_ratio * modem.bit_rate_bps / modem.bandwidth_hz);
    EXPECT_NEAR(half_delivery_sinr(modem, bytes)->value, expected_db, 2e-3) << bytes;
  }
}

TEST(HalfDelivery, TakesTheWeakerOfPreambleAndBits) {
  Modem modem = generic_modem(Decibels{185}, Decibels{70}, 25'000, 5'000);
  modem.error_model = ErrorModel::kNone;
  EXPECT_EQ(half_delivery_sinr(modem, 32), std::nullopt);
  modem.packet_overhead = modem.preamble = SimDuration::from_milliseconds(2);
  const auto preamble = half_delivery_sinr(modem, 32);
  ASSERT_TRUE(preamble);
  EXPECT_NEAR(acquisition_probability(modem, to_power_ratio(*preamble)), 0.5, 1e-3);
  modem.error_model = ErrorModel::kBfsk;
  EXPECT_GE(half_delivery_sinr(modem, 32)->value, preamble->value);
}

TEST(HalfDelivery, PayloadBeyondTheModemsIsRefused) {
  EXPECT_THROW(half_delivery_sinr(Modem(), kMaxPayloadBytes + 1), InvalidArgument);
}

}  // namespace
}  // namespace halocline::acoustics
