// Predicted against realised: the probabilities of 4000 packets of one link, each decided as the medium decides it, have
// the mean that the prediction of the link states, within 2 % of probability.
#include "acoustics/reception/link_prediction.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/fading/link_fading.h"
#include "acoustics/fading/path_fading.h"
#include "acoustics/fading/sound_path.h"
#include "acoustics/modem/modem.h"
#include "acoustics/reception/reception_curves.h"
#include "acoustics/reception/signal_history.h"
#include "channel_server/modems/modem_config.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/reception_decision.h"
#include "core/sim_time.h"

namespace halocline::channel_server {
namespace {

using acoustics::FadingModel;
using acoustics::SoundPath;

constexpr std::size_t kPayloadBytes = 32;
constexpr int kPackets = 4000;

SoundPath path(double delay_s, double level_db, double surface_sine_squares, double bottom_sine_squares,
               double wind_mps, double frequency_hz, std::uint64_t identity) {
  SoundPath one{.delay_s = delay_s, .level = {level_db}, .identity = identity};
  one.launch_angle_rad = 0.05 * static_cast<double>(identity);
  one.phase_rad = static_cast<double>(identity);
  one.fading = path_fading(FadingModel{.enabled = true}, wind_mps, frequency_hz, surface_sine_squares,
                           bottom_sine_squares);
  return one;
}

// Paths of three seas: a steady direct one, a fan off a moving surface, a long tail off surface and bottom.
std::vector<SoundPath> sea(int which, double frequency_hz) {
  const auto p = [&](double delay_ms, double level_db, double surface, double bottom, double wind,
                     std::uint64_t id) {
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
};

class PredictedLink : public ::testing::TestWithParam<Case> {};

TEST_P(PredictedLink, DeliversAsManyPacketsAsRealised) {
  const FadingModel model{.enabled = true};
  const acoustics::Modem modem = load_modem(GetParam().profile).modem;
  const std::vector<SoundPath> paths = sea(GetParam().sea, modem.centre_frequency_hz);
  const acoustics::Lock lock{&modem, best_window(paths, modem)};
  const acoustics::ReceptionCurves curves(modem, std::min(kPayloadBytes, max_payload_bytes(modem)));
  const acoustics::PacketTiming timing = curves.timing();
  Packet packet;
  packet.modem = modem;
  packet.timing = timing;
  const auto shared = std::make_shared<const Packet>(packet);
  for (const double noise_db : {-20.0, -10.0, -5.0, 0.0, 4.0, 8.0, 12.0, 16.0, 20.0}) {
    const double noise = std::pow(10, noise_db / 10);
    const auto predicted = predict_link(model, paths, lock, modem.band(), noise, curves);
    double acquired = 0, delivered = 0;
    for (std::uint32_t i = 0; i < kPackets; ++i) {
      const acoustics::FadingLink link{.seed = 12, .lower_id = i, .higher_id = 9999};
      const SimTime begin = SimTime::from_seconds(100);
      const acoustics::LinkFading fading(model, link);
      ReceivedSignal signal{shared, noise, begin, begin + timing.preamble, begin + timing.duration,
                            true,   {},    {}};
      signal.history = signal_history(model, link, fading.large_scale(begin), paths, lock, modem.band(),
                                      begin, {timing.preamble.seconds(), timing.duration.seconds()});
      const double acquisition = acquisition_probability(signal, {});
      acquired += acquisition / kPackets;
      delivered += acquisition * success_probability(signal, {}) / kPackets;
    }
    EXPECT_NEAR(predicted.acquisition_probability, acquired, 0.02) << "noise " << noise_db;
    EXPECT_NEAR(predicted.delivery_probability, delivered, 0.02) << "noise " << noise_db;
  }
}

INSTANTIATE_TEST_SUITE_P(Seas, PredictedLink,
                         ::testing::Values(Case{"micromodem-fsk", 1}, Case{"micromodem-psk-1", 0},
                                           Case{"micromodem-psk-5", 0}),
                         [](const auto& parameter) {
                           std::string name = std::string(parameter.param.profile) + "_sea" +
                                              std::to_string(parameter.param.sea);
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

}  // namespace
}  // namespace halocline::channel_server
