// SPDX-License-Identifier: BSD-3-Clause
// What receivers collect and lose: SINR = n S / (N 10^(loss / 10) + I), late echoes, the strongest path
// alone, and the maker's simulated receiver of NM3 with none, one and two equal echoes.
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/fading/arrival.h"
#include "acoustics/fading/path_fading.h"
#include "acoustics/modem/error_model.h"
#include "acoustics/modem/modem.h"
#include "acoustics/modem/orthogonal_symbols.h"
#include "acoustics/modem/receiver_kind.h"
#include "acoustics/prediction/link_prediction.h"
#include "acoustics/reception/guard_window.h"
#include "acoustics/reception/reception_curves.h"
#include "acoustics/reception/signal_history.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

constexpr double kSpreadHz = 2;

Arrival path_with(double delay_s, double level_db, double spread_hz = 0) {
  Arrival path{{.delay_s = delay_s}, {level_db}};
  path.fading.doppler_spread_hz = spread_hz;
  return path;
}

// `echoes` paths of one power, 20 ms apart, after a first one; each of power 1.
std::vector<Arrival> equal_paths(int echoes) {
  std::vector<Arrival> paths;
  for (int i = 0; i <= echoes; ++i) paths.push_back(path_with(1 + 0.02 * i, 0));
  return paths;
}

// NM3's receiver: the strongest path, and symbols of 16 codes at 640 bit/s in 8 kHz.
Modem strongest_path_modem() {
  Modem modem;
  modem.receiver = ReceiverKind::kStrongestPath;
  modem.late_echo_share = 0.5;
  modem.error_model = ErrorModel::kOrthogonal16;
  modem.centre_frequency_hz = 28'000;
  modem.bandwidth_hz = 8'000;
  modem.bit_rate_bps = 640;
  modem.packet_overhead = SimDuration::from_milliseconds(105);
  modem.preamble = SimDuration::from_seconds(0.0525);
  modem.layout.tail_bits = 128;
  return modem;
}

// Interference after the window, of paths of power 1.
double late_power(const std::vector<Arrival>& paths, const Modem& modem) {
  const GuardWindow window = best_window(paths, modem);
  double sum = 0;
  for (const WindowShare& share : window.shares) sum += share.interference;
  return sum;
}

// SNR of all paths together, dB, at which the strongest path has the ratio `sinr` over noise and echoes.
double snr_of_all_db(double sinr, int echoes) {
  const std::vector<Arrival> paths = equal_paths(echoes);
  const Modem modem = strongest_path_modem();
  const double signal = mean_signal(paths, best_window(paths, modem));
  const double noise = signal / sinr - late_power(paths, modem);
  return to_decibels({static_cast<double>(paths.size()) / noise}).value;
}

// (1 / a) / (N / P + kappa (a - 1) / a) = 10^-0.71, a the paths, P the power of all.
TEST(StrongestPath, OfEqualEchoesNeedsTheTabulatedRatios) {
  const double sinr = std::pow(10, -0.71);
  EXPECT_NEAR(snr_of_all_db(sinr, 0), -7.1, 1e-9);
  EXPECT_NEAR(snr_of_all_db(sinr, 1), -3.64420953926, 1e-9);
  EXPECT_NEAR(snr_of_all_db(sinr, 2), -1.38683009352, 1e-9);
}

// Packet error of 16 bytes by the SNR of all paths.
double packet_error(double snr_db, int echoes) {
  const std::vector<Arrival> paths = equal_paths(echoes);
  const Modem modem = strongest_path_modem();
  const ReceptionCurves curves(modem, 16);
  const GuardWindow window = best_window(paths, modem);
  // The echoes sound throughout a packet that is long against their delays.
  const double noise = static_cast<double>(paths.size()) / std::pow(10, snr_db / 10);
  const double sinr = mean_signal(paths, window) / (noise + late_power(paths, modem));
  return 1 - curves.acquisition(sinr) * std::exp(128 * curves.log_bit_success(sinr));
}

// Maker's simulated receiver, 16 bytes: SNR of all paths in dB and packet error.
struct PublishedError {
  int echoes;
  double snr_db, error;
};
constexpr std::array kPublished = std::to_array<PublishedError>(
    {{0, -9, 0.984}, {0, -8, 0.777}, {0, -7, 0.482}, {0, -6, 0.225}, {0, -5, 0.070},
     {0, -4, 0.017}, {0, -3, 0.001}, {1, -6, 0.998}, {1, -5, 0.944}, {1, -4, 0.605},
     {1, -3, 0.228}, {1, -2, 0.061}, {1, -1, 0.011}, {2, -4, 0.998}, {2, -3, 0.944},
     {2, -2, 0.717}, {2, -1, 0.412}, {2, 0, 0.161},  {2, 1, 0.047},  {2, 2, 0.015}});

TEST(StrongestPath, ErrsAsTheMakersOfNm3PublishOfSixteenBytes) {
  for (const PublishedError& row : kPublished)
    EXPECT_NEAR(packet_error(row.snr_db, row.echoes), row.error, 0.12) << row.echoes << " " << row.snr_db;
}

TEST(StrongestPath, HalfOfThePacketsArriveWhereTheMakersHalfDoes) {
  constexpr std::array<double, 3> kHalf_db{-7.1, -3.7, -1.3};
  for (int echoes = 0; echoes < 3; ++echoes) {
    double low_db = -15, high_db = 10;
    while (high_db - low_db > 1e-3) {
      const double middle_db = (low_db + high_db) / 2;
      (packet_error(middle_db, echoes) > 0.5 ? low_db : high_db) = middle_db;
    }
    EXPECT_NEAR(low_db, kHalf_db[static_cast<std::size_t>(echoes)], 0.3) << echoes;
  }
}

TEST(StrongestPath, CollectsWhatItsBandCannotPart) {
  const Modem modem = strongest_path_modem();  // 1 / 8 kHz is 125 us
  EXPECT_EQ(best_window({path_with(1, 0), path_with(1.0001, -3)}, modem).shares[1].weight, 1);
  const GuardWindow apart = best_window({path_with(1, 0), path_with(1.0003, -3)}, modem);
  EXPECT_EQ(apart.shares[1].weight, 0);
  EXPECT_EQ(apart.shares[1].interference, 0.5);
}

TEST(OrthogonalSymbols, OfTwoTailsAreTheSeriesAndOfNoEnergyAGuess) {
  EXPECT_NEAR(orthogonal16_symbol_error_rate({0}), 15.0 / 16, 1e-9);
  // The first term dominates: 7.5 exp(-g / 2).
  EXPECT_NEAR(orthogonal16_symbol_error_rate({40}) / (7.5 * std::exp(-20.0)), 1, 0.01);
}

TEST(Receiver, LateEchoesDisturbByKappaAndByWhatFeedbackLeaves) {
  Modem modem;
  modem.error_model = ErrorModel::kBpsk;
  modem.late_echo_share = 0.8;
  modem.echo_cancelled = 0.9;
  const auto disturbs = [&](double spread_hz) {
    return best_window({path_with(1, 0), path_with(1.05, -1, spread_hz)}, modem).shares[1].interference;
  };
  EXPECT_NEAR(disturbs(0), 0.8 * (1 - 0.9), 1e-12);
  const double rho = std::exp(-std::pow(2 * std::numbers::pi * kSpreadHz * 0.05, 2) / 2);
  EXPECT_NEAR(disturbs(kSpreadHz), 0.8 * (1 - 0.9 * rho), 1e-9);
  EXPECT_NEAR(disturbs(100), 0.8, 1e-9);  // too fast to be followed
}

TEST(Receiver, OnlyAnEqualiserTracksFading) {
  Modem modem;
  modem.error_model = ErrorModel::kBpsk;
  const Arrival path = path_with(1, 0, kSpreadHz);
  EXPECT_LT(tracked_share(modem, path), 1);
  modem.receiver = ReceiverKind::kStrongestPath;
  EXPECT_EQ(tracked_share(modem, path), 1);
  modem.receiver = ReceiverKind::kHops;
  EXPECT_EQ(tracked_share(modem, path), 1);
}

// Three decibels of loss are three decibels of noise, four hydrophones six of signal; of acquisition, too.
TEST(Receiver, LossAndHydrophonesMoveTheRatioByTheirDecibels) {
  const FadingModel fading{.enabled = true};
  const std::vector<Arrival> paths{path_with(1, 10)};
  Modem modem;
  modem.error_model = ErrorModel::kBpsk;
  modem.bit_rate_bps = 1000;
  modem.packet_overhead = modem.preamble = SimDuration::from_milliseconds(5);
  const ReceptionCurves curves(modem, 32);
  const auto predicted = [&](double noise) {
    return predict_link(fading, paths, {&modem, best_window(paths, modem)}, modem.band(), noise, curves);
  };
  const LinkPrediction plain = predicted(1);
  modem.receiver_loss = {3};
  const double louder = std::pow(10, 0.3);
  EXPECT_NEAR(predicted(1).sinr * louder, plain.sinr, 1e-9 * plain.sinr);
  EXPECT_NEAR(predicted(1 / louder).acquisition_probability, plain.acquisition_probability, 1e-9);
  EXPECT_NEAR(predicted(1 / louder).delivery_probability, plain.delivery_probability, 1e-9);
  modem.receiver_loss = {0};
  modem.receiver_channels = 4;
  EXPECT_NEAR(predicted(1).sinr, 4 * plain.sinr, 1e-9 * plain.sinr);
  EXPECT_NEAR(predicted(4).delivery_probability, plain.delivery_probability, 1e-9);
  EXPECT_NEAR(receiver_gain(modem).value, 10 * std::log10(4), 1e-9);
}

TEST(Receiver, AsAStructIsNeutral) {
  const Modem modem;
  EXPECT_EQ(noise_factor(modem), 1);
  EXPECT_EQ(receiver_gain(modem).value, 0);
  EXPECT_EQ(modem.window_s(), modem.guard_time.seconds());
  EXPECT_EQ(modem.window_taper_s(), modem.guard_taper_or_default().seconds());
  const GuardWindow window = best_window({path_with(1, 0), path_with(1.05, -1, kSpreadHz)}, modem);
  EXPECT_EQ(window.shares[1].interference, 1);
}

// Disturbances of a prediction add up to 1 / SINR.
TEST(Receiver, DisturbancesAddUpToTheRatio) {
  const FadingModel fading{.enabled = true};
  Modem modem;
  modem.error_model = ErrorModel::kBpsk;
  modem.receiver_loss = {3};
  modem.receiver_channels = 4;
  modem.echo_cancelled = 0.9;
  std::vector<Arrival> paths{path_with(1, 0), path_with(1.003, -2), path_with(1.06, -3)};
  for (std::size_t i = 1; i < paths.size(); ++i)
    paths[i].fading = path_fading(fading, 6, 25'000, 0.01 * static_cast<double>(i), 0);
  const ReceptionCurves curves(modem, 32);
  const LinkPrediction one =
      predict_link(fading, paths, {&modem, best_window(paths, modem)}, modem.band(), 0.02, curves);
  EXPECT_NEAR(one.disturbances.sum() * one.sinr, 1, 1e-9);
  EXPECT_GT(one.disturbances.late_echoes, 0);
  EXPECT_GT(one.disturbances.fast_fading, 0);
}

TEST(PulseCode, APulseHoldsItsEnergyInItsChip) {
  Modem tag;
  tag.error_model = ErrorModel::kPulses;
  tag.bandwidth_hz = 100;
  tag.chip = SimDuration::from_milliseconds(10);
  tag.bit_rate_bps = 2;
  EXPECT_NEAR(bit_energy(tag, {5}).value, 5, 1e-12);  // B T = 1
  // Detection of a pulse of which only noise is there: the false alarms, so that it is missed otherwise.
  EXPECT_NEAR(bit_error_rate(tag, {0}), 0.999, 1e-12);
  EXPECT_LT(bit_error_rate(tag, {20}), 0.01);
}

}  // namespace
}  // namespace halocline::acoustics
