// SPDX-License-Identifier: BSD-3-Clause
// Predicted against realised: the probabilities of 10 000 packets, each decided as the medium decides it,
// have the mean that the prediction of their link states, within 2 % of probability and what chance may add
// to 10 000 with 99 % confidence.
#include "acoustics/prediction/link_prediction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/fading/arrival.h"
#include "acoustics/fading/link_fading.h"
#include "acoustics/fading/path_fading.h"
#include "acoustics/modem/error_model.h"
#include "acoustics/modem/modem.h"
#include "acoustics/modem/packet_format.h"
#include "acoustics/modem/receiver_kind.h"
#include "acoustics/reception/reception_curves.h"
#include "acoustics/reception/signal_history.h"
#include "channel_server/modems/modem_config.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/reception_decision.h"
#include "core/sim_time.h"
#include "tests/channel_server/sea/jittered_paths.h"
#include "tests/support/doc_table.h"

namespace halocline::channel_server {
namespace {

using acoustics::Arrival;
using acoustics::FadingModel;

constexpr std::size_t kPayloadBytes = 32;
constexpr int kPackets = 10'000;     // independent: of a link each
constexpr double kConfidence = 2.6;  // standard deviations of the mean of those: 99 %

Arrival path(double delay_s, double level_db, double surface_sine_squares, double bottom_sine_squares,
             double wind_mps, double frequency_hz, int identity) {
  Arrival one{{.delay_s = delay_s, .identity = {.branch = identity}}, {level_db}};
  one.launch_angle_rad = 0.05 * identity;
  one.phase_rad = identity;
  one.fading = path_fading(FadingModel{.enabled = true}, wind_mps, frequency_hz, surface_sine_squares,
                           bottom_sine_squares);
  return one;
}

// Paths of three seas: a steady direct one, a fan off a moving surface, a long tail off surface and bottom.
std::vector<Arrival> sea(int which, double frequency_hz) {
  const auto p = [&](double delay_ms, double level_db, double surface, double bottom, double wind, int id) {
    return path(1 + delay_ms / 1000, level_db, surface, bottom, wind, frequency_hz, id);
  };
  if (which == 0) return {p(0, 0, 0, 0, 0, 1), p(0.4, -8, 0, 0.003, 0, 2)};
  if (which == 1)
    return {p(0, 0, 0.005, 0, 5, 1), p(0.7, -1, 0.02, 0.01, 5, 2), p(1.6, -3, 0.05, 0.03, 5, 3)};
  return {p(0, -2, 0, 0.01, 8, 1),  p(1.1, 0, 0.04, 0, 8, 2),  p(2.9, -1, 0.06, 0.04, 8, 3),
          p(7, -4, 0.1, 0.1, 8, 4), p(19, -6, 0.2, 0.2, 8, 5), p(40, -9, 0.3, 0.3, 8, 6)};
}

struct Case {
  const char* profile;
  int sea;
  // Another receiver than the profile's, with its name; null: the profile's.
  void (*turn)(acoustics::Modem&) = nullptr;
  const char* turned = "";
};

class PredictedLink : public ::testing::TestWithParam<Case> {};

// Mean of the packets' probabilities.
struct Share {
  double mean = 0, squares = 0;
  void add(double probability) {
    mean += probability / kPackets;
    squares += probability * probability / kPackets;
  }
  double bound() const {
    return 0.02 + kConfidence * std::sqrt(std::max(squares - mean * mean, 0.0) / kPackets);
  }
};

TEST_P(PredictedLink, DeliversAsManyPacketsAsRealised) {
  constexpr std::array<double, 9> kNoiseDb{-20, -10, -5, 0, 4, 8, 12, 16, 20};
  const FadingModel model{.enabled = true};
  acoustics::Modem modem = load_modem(GetParam().profile).modem;
  if (GetParam().turn != nullptr) GetParam().turn(modem);
  const std::vector<Arrival> paths = sea(GetParam().sea, modem.centre_frequency_hz);
  const acoustics::Synchronisation sync{&modem, best_window(paths, modem)};
  const acoustics::ReceptionCurves curves(modem, std::min(kPayloadBytes, max_payload_bytes(modem)));
  const acoustics::PacketTiming timing = curves.timing();
  Packet packet;
  packet.modem = modem;
  packet.timing = timing;
  packet.format = data_format(modem, std::min(kPayloadBytes, max_payload_bytes(modem)));
  const auto shared = std::make_shared<const Packet>(packet);
  const SimTime begin = SimTime::from_seconds(100);
  std::array<Share, kNoiseDb.size()> acquired{}, delivered{};
  for (std::uint32_t i = 0; i < kPackets; ++i) {
    const acoustics::FadingLink link{.seed = 12, .lower_id = i, .higher_id = 99'999};
    const acoustics::LinkFading fading(model, link);
    ReceivedSignal signal{shared, 0, begin, begin + timing.preamble, begin + timing.duration, true, {}, {}};
    signal.history = signal_history(
        model, link, fading.large_scale(begin), testing::jittered(paths, modem.centre_frequency_hz, i), sync,
        modem.band(), begin, {timing.preamble.seconds(), timing.duration.seconds()});
    for (std::size_t k = 0; k < kNoiseDb.size(); ++k) {
      signal.noise = std::pow(10, kNoiseDb[k] / 10);
      const double acquisition = acquisition_probability(signal, {});
      const double delivery = acquisition > 1e-9 ? acquisition * success_probability(signal, {}) : 0;
      acquired[k].add(acquisition);
      delivered[k].add(delivery);
    }
  }
  double worst_acquired = 0, worst_delivered = 0;
  std::size_t half = 0;  // where delivery is closest to a half
  std::array<double, kNoiseDb.size()> promised{};
  for (std::size_t k = 0; k < kNoiseDb.size(); ++k) {
    const auto predicted =
        predict_link(model, paths, sync, modem.band(), std::pow(10, kNoiseDb[k] / 10), curves);
    EXPECT_NEAR(predicted.acquisition_probability, acquired[k].mean, acquired[k].bound());
    EXPECT_NEAR(predicted.delivery_probability, delivered[k].mean, delivered[k].bound());
    promised[k] = predicted.delivery_probability;
    worst_acquired = std::max(worst_acquired, std::abs(predicted.acquisition_probability - acquired[k].mean));
    worst_delivered = std::max(worst_delivered, std::abs(promised[k] - delivered[k].mean));
    if (std::abs(delivered[k].mean - 0.5) < std::abs(delivered[half].mean - 0.5)) half = k;
  }
  const auto cell = [](double value) {
    std::array<char, 16> text{};
    std::snprintf(text.data(), text.size(), "%.3f", value);
    return std::string(text.data());
  };
  if (GetParam().turn != nullptr) return;
  halocline::testing::doc_row(
      "predicted",
      {std::string(GetParam().profile) + ", sea " + std::to_string(GetParam().sea + 1), cell(promised[half]),
       cell(delivered[half].mean), cell(worst_acquired), cell(worst_delivered)});
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const char* profile : {"generic", "janus", "micromodem-fsk", "micromodem-psk-1", "micromodem-psk-5"}) {
    for (int sea = 0; sea < 3; ++sea) all.push_back({profile, sea});
  }
  const auto equaliser = [](acoustics::Modem& modem) {
    modem.receiver_loss = {3};
    modem.receiver_channels = 4;
    modem.echo_cancelled = 0.9;
  };
  const auto strongest_path = [](acoustics::Modem& modem) {
    modem.receiver = acoustics::ReceiverKind::kStrongestPath;
    modem.late_echo_share = 0.5;
    modem.error_model = acoustics::ErrorModel::kOrthogonal16;
    modem.bandwidth_hz = 8'000;
  };
  for (const int sea : {1, 2}) {
    all.push_back({"micromodem-psk-1", sea, equaliser, "_with_equaliser"});
    all.push_back({"nm3", sea, strongest_path, "_of_strongest_path"});
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Seas, PredictedLink, ::testing::ValuesIn(cases()), [](const auto& parameter) {
  std::string name = std::string(parameter.param.profile) + parameter.param.turned + "_sea" +
                     std::to_string(parameter.param.sea);
  for (char& c : name) c = c == '-' ? '_' : c;
  return name;
});

}  // namespace
}  // namespace halocline::channel_server
