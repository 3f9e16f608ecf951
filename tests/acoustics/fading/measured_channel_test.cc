// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/fading/measured_channel.h"

#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acoustics/fading/arrival.h"
#include "acoustics/fading/complex_noise.h"
#include "acoustics/fading/link_fading.h"
#include "acoustics/fading/measured_fading.h"
#include "acoustics/fading/path_responses.h"
#include "core/check.h"
#include "core/random.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;
using ::testing::HasSubstr;

constexpr Band kBand{22'500, 27'500};

// 5 kHz about 25 kHz, 10 responses a second.
template <class Tap>
ChannelRecord record_of(std::size_t instants, std::size_t delays, Tap tap, double time_rate_hz = 10) {
  ChannelRecord record{"test.mat", 25'000, 5000, time_rate_hz, delays, {}};
  for (std::size_t i = 0; i < instants; ++i) {
    for (std::size_t k = 0; k < delays; ++k) record.taps.emplace_back(std::complex<float>(tap(i, k)));
  }
  return record;
}

ChannelRecord ramp() {
  return record_of(4, 1, [](std::size_t i, std::size_t) { return Complex(static_cast<double>(i) + 1); });
}

TEST(MeasuredChannel, InItsOwnBandHasTheTapsOfTheRecord) {
  // A path's response lacks the phase of its delay at the centre, 25.001 kHz of 0.6 ms: 15.0006 cycles.
  ChannelRecord record = record_of(5, 4, [](std::size_t, std::size_t k) {
    return k == 0 ? Complex(1) : k == 3 ? Complex(0, 0.5) : 0;
  });
  record.carrier_hz = 25'001;
  const MeasuredChannel channel(record, record.band());
  ASSERT_EQ(channel.taps().size(), 2u);
  const MeasuredTap &first = channel.taps()[0], &second = channel.taps()[1];
  EXPECT_EQ(first.delay_s, 0);
  EXPECT_NEAR(second.delay_s, 3 / 5000.0, 1e-15);
  EXPECT_NEAR(first.power, 1, 1e-6);
  EXPECT_NEAR(second.power, 0.25, 1e-6);
  EXPECT_NEAR(channel.power(), 1.25, 1e-6);
  EXPECT_NEAR(second.phase_rad, pi / 2 + 2 * pi * 0.0006, 1e-6);
  for (const MeasuredTap& tap : channel.taps()) {
    EXPECT_NEAR(tap.coherent, 1, 1e-6);
    EXPECT_EQ(tap.doppler_spread_hz, 0);
  }
  const auto values = channel.values(0.123, 0.01, 1);
  EXPECT_NEAR(std::abs(values[0] - 1.0), 0, 1e-6);
  EXPECT_NEAR(std::abs(values[1] - std::polar(0.5, pi / 2 + 2 * pi * 0.0006)), 0, 1e-6);
}

// Mean over the band of |1 + a exp(-j 2 pi (f - fc) tau)|^2 = 1 + a^2 + 2 a sinc(B tau) cos(2 pi (f0 - fc)
// tau).
TEST(MeasuredChannel, InANarrowerBandHasTheMeanPowerOfThatBand) {
  const double a = 0.8, tau_s = 1 / 5000.0;
  const ChannelRecord record = record_of(3, 30, [&](std::size_t, std::size_t k) {
    return Complex(k == 10 ? 1 : k == 11 ? a : 0);
  });
  for (const Band band : {Band{24'000, 26'000}, Band{22'600, 24'100}, Band{25'500, 27'400}}) {
    const double x = pi * band.width_hz() * tau_s;
    const double expected =
        1 + a * a + 2 * a * std::sin(x) / x * std::cos(2 * pi * (band.centre_hz() - 25'000) * tau_s);
    // Of a sharp tap, what is left out before the first tap, beyond the sinc's end and below 0.1 % takes 3 %
    // at most.
    const double loss_db = 10 * std::log10(expected / MeasuredChannel(record, band).power());
    EXPECT_GT(loss_db, 0);
    EXPECT_LT(loss_db, 0.13);
  }
}

// |H| at the middle of the band, far from the sinc's ends in frequency.
TEST(MeasuredChannel, InANarrowerBandHasTheResponseOfItsMiddle) {
  const ChannelRecord record = record_of(3, 30, [](std::size_t, std::size_t k) {
    return k == 10 ? Complex(1) : k == 13 ? Complex(0, 0.6) : 0;
  });
  const Band band{23'700, 25'300};
  const MeasuredChannel channel(record, band);
  const auto values = channel.values(0, 1, 1);
  for (const double f : {24'300.0, 24'500.0, 24'700.0}) {
    Complex sum;
    for (std::size_t p = 0; p < values.size(); ++p) {
      sum += values[p] * std::polar(1.0, -2 * pi * f * channel.taps()[p].delay_s);
    }
    const double expected =
        std::abs(1.0 + Complex(0, 0.6) * std::polar(1.0, -2 * pi * (f - 25'000) * 3 / 5000));
    EXPECT_NEAR(std::abs(sum), expected, 0.05) << f;  // of 1.17 rms: likewise
  }
}

TEST(MeasuredChannel, IsLinearBetweenInstantsAndBeginsAgainAfterTheLast) {
  const MeasuredChannel channel(ramp(), kBand);
  EXPECT_NEAR(channel.duration_s(), 0.4, 1e-12);
  const auto values = channel.values(0.05, 0.1, 5);
  const std::vector<double> expected{1.5, 2.5, 3.5, 2.5, 1.5};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(std::abs(values[i] - expected[i]), 0, 1e-6) << i;
  }
  EXPECT_NEAR(channel.values(-0.35, 1, 1)[0].real(), 1.5, 1e-6);  // before the first comes the last
}

TEST(MeasuredChannel, MeanPowerIsThatOfTheValuesInBetween) {
  const MeasuredChannel channel(ramp(), kBand);
  double sum = 0;
  const std::size_t count = 10'000;
  for (const Complex value : channel.values(0.5 * 0.4 / count, 0.4 / count, count)) sum += std::norm(value);
  EXPECT_NEAR(sum / count / channel.power(), 1, 1e-6);
}

TEST(MeasuredChannel, DopplerSpreadIsThatOfTheFadingInTheRecord) {
  const ComplexNoise noise({.seed = 5, .purpose = purpose_of("test")});
  const auto fading = [&](std::size_t i, std::size_t) { return noise.at(static_cast<double>(i) / 20, 1.5); };
  const MeasuredTap scattered = MeasuredChannel(record_of(4000, 1, fading, 20), kBand).taps()[0];
  EXPECT_NEAR(scattered.doppler_spread_hz, 1.5, 0.05);
  EXPECT_LT(scattered.coherent, 0.01);
  // A shift is no spread.
  const auto turning = [](std::size_t i, std::size_t) {
    return std::polar(1.0, 0.3 * static_cast<double>(i));
  };
  EXPECT_NEAR(MeasuredChannel(record_of(4000, 1, turning, 20), kBand).taps()[0].doppler_spread_hz, 0, 1e-2);
}

TEST(MeasuredChannel, LeavesOutWeakTapsAndWhatComesBeforeTheFirstSignificant) {
  const std::vector<double> amplitudes{0.06, 0, 0.2, 0, 1, 0.001};
  const MeasuredChannel channel(
      record_of(3, 6, [&](std::size_t, std::size_t k) { return Complex(amplitudes[k]); }), kBand);
  ASSERT_EQ(channel.taps().size(), 2u);
  EXPECT_NEAR(channel.taps()[0].power, 0.04, 1e-6);
  EXPECT_NEAR(channel.taps()[1].delay_s, 2 / 5000.0, 1e-12);
}

TEST(MeasuredChannel, RefusesABandThatWasNotMeasured) {
  try {
    MeasuredChannel(ramp(), {27'000, 28'000});
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_THAT(error.what(), HasSubstr("test.mat: was measured from 22500 to 27500 Hz"));
  }
}

TEST(MeasuredChannel, RefusesRecordsThatAreNoChannel) {
  const auto refusal_of = [](auto change) {
    ChannelRecord record = ramp();
    change(record);
    try {
      validate(record);
    } catch (const InvalidArgument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal_of([](ChannelRecord&) {}), "");
  EXPECT_THAT(refusal_of([](ChannelRecord& r) { r.delay_rate_hz = 0; }), HasSubstr("params/fs_delay"));
  EXPECT_THAT(refusal_of([](ChannelRecord& r) { r.time_rate_hz = -1; }), HasSubstr("params/fs_time"));
  EXPECT_THAT(refusal_of([](ChannelRecord& r) { r.carrier_hz = 2000; }), HasSubstr("params/fc"));
  EXPECT_THAT(refusal_of([](ChannelRecord& r) { r.taps.resize(1); }), HasSubstr("1 instants"));
  EXPECT_THAT(refusal_of([](ChannelRecord& r) { r.taps.assign(4, {}); }), HasSubstr("0 everywhere"));
  EXPECT_THAT(refusal_of([](ChannelRecord& r) {
                r.taps[2] = {std::numeric_limits<float>::infinity(), 0};
              }),
              HasSubstr("instant 2, delay 0"));
}

class MeasuredFadingTest : public ::testing::Test {
 protected:
  static FadingLink link(std::uint64_t seed, std::uint32_t low, std::uint32_t high) {
    return {.seed = seed, .lower_id = low, .higher_id = high};
  }
  std::shared_ptr<const MeasuredChannel> channel = std::make_shared<const MeasuredChannel>(
      record_of(50, 3,
                [](std::size_t i, std::size_t k) {
                  return std::polar(1.0 + 0.02 * static_cast<double>(i * (k + 1) % 50),
                                    0.1 * static_cast<double>(i * k));
                }),
      kBand);
  Arrival reference{{.delay_s = 2, .arrival_angle_rad = 0.2}, {70}, 1.001};
  std::vector<Arrival> paths = measured_paths(*channel, reference, {80});
};

TEST_F(MeasuredFadingTest, PathsArriveAfterTheReferenceAndHaveTheLevelInAll) {
  ASSERT_EQ(paths.size(), 3u);
  double power = 0;
  for (std::size_t p = 0; p < 3; ++p) {
    EXPECT_NEAR(paths[p].delay_s, 2 + static_cast<double>(p) / 5000, 1e-12);
    EXPECT_EQ(paths[p].doppler_factor, 1.001);
    EXPECT_EQ(paths[p].arrival_angle_rad, 0.2);
    EXPECT_EQ(paths[p].fading.coherent + paths[p].fading.scattered, 1);
    EXPECT_EQ(paths[p].fading.doppler_spread_hz, channel->taps()[p].doppler_spread_hz);
    power += to_power_ratio(paths[p].level).value;
  }
  EXPECT_NEAR(to_decibels(PowerRatio{power}).value, 80, 1e-9);
}

TEST_F(MeasuredFadingTest, ResponsesHaveThePowerOfTheirPathsOverTheRecord) {
  const MeasuredFading fading(channel, link(1, 2, 3));
  const FadingTimes times{0.0005, 0.001, 5000};  // the record's 5 s
  const auto h = fading.responses(paths, kBand, SimTime::from_seconds(77), times, 1);
  for (std::size_t p = 0; p < 3; ++p) {
    double sum = 0;
    for (std::size_t i = 0; i < 5000; ++i) sum += std::norm(h[p * 5000 + i]);
    EXPECT_NEAR(10 * std::log10(sum / 5000) - paths[p].level.value, 0, 1e-3);
  }
  const auto louder = fading.responses(paths, kBand, SimTime::from_seconds(77), times, 2);
  EXPECT_NEAR(std::abs(louder[17] - 2.0 * h[17]), 0, 1e-9);
}

TEST_F(MeasuredFadingTest, EachPairAndSeedIsSomewhereElseInTheRecord) {
  const MeasuredFading one(channel, link(1, 2, 3)), same(channel, link(1, 2, 3)),
      pair(channel, link(1, 2, 4)), seed(channel, link(2, 2, 3));
  EXPECT_EQ(one.offset_s(), same.offset_s());
  EXPECT_NE(one.offset_s(), pair.offset_s());
  EXPECT_NE(one.offset_s(), seed.offset_s());
  EXPECT_GE(one.offset_s(), 0);
  EXPECT_LE(one.offset_s(), channel->duration_s());
  // The value is the table's there.
  const auto h = one.responses(paths, kBand, SimTime::from_seconds(10), {0.25, 0.1, 1}, 1);
  const double scale = std::sqrt(to_power_ratio(paths[1].level).value / channel->taps()[1].power);
  EXPECT_NEAR(std::abs(h[1] / scale - channel->values(10.25 + one.offset_s(), 1, 1)[1]), 0, 1e-9);
}

TEST_F(MeasuredFadingTest, InstantsDoNotDependOnWhatElseIsEvaluated) {
  const MeasuredFading fading(channel, link(1, 2, 3));
  const auto many = fading.responses(paths, kBand, SimTime::from_seconds(3), {0, 0.125, 9}, 1);
  const auto single = fading.responses(paths, kBand, SimTime::from_seconds(3), {0.5, 1, 1}, 1);
  for (std::size_t p = 0; p < 3; ++p) EXPECT_EQ(many[p * 9 + 4], single[p]);
}

}  // namespace
}  // namespace halocline::acoustics
