// SPDX-License-Identifier: BSD-3-Clause
// Deliveries at shifts of the margin, which share the statistics of the link as it is, beside predictions of
// their own.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/fading/arrival.h"
#include "acoustics/fading/path_fading.h"
#include "acoustics/modem/error_model.h"
#include "acoustics/modem/modem.h"
#include "acoustics/prediction/link_prediction.h"
#include "acoustics/reception/guard_window.h"
#include "acoustics/reception/reception_curves.h"
#include "channel_server/modems/modem_config.h"
#include "core/random.h"
#include "core/units.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using halocline::testing::tolerance;

constexpr FadingModel kSea{.enabled = true};

// Up to 12 paths of 100 dB and below, drawn at random.
std::vector<Arrival> paths_of(std::uint32_t place) {
  const auto draw = [&](std::uint64_t i) { return uniform_at({.seed = 9, .who = place, .which = i}); };
  std::vector<Arrival> paths;
  double delay_s = 1;
  for (std::uint64_t i = 0; i < 1 + static_cast<std::uint64_t>(11 * draw(0)); ++i) {
    Arrival path;
    path.delay_s = delay_s += 0.006 * draw(10 + i);
    path.level = Decibels{100 - 3.0 * static_cast<double>(i) * draw(50 + i)};
    path.phase_rad = 6.28 * draw(100 + i);
    path.launch_angle_rad = 0.5 * (draw(150 + i) - 0.5);
    path.arrival_angle_rad = -path.launch_angle_rad;
    const double coherent = i == 0 ? 0.9 : draw(200 + i);
    path.fading = {coherent * 0.9, coherent * 0.1, 1 - coherent, 2 * draw(300 + i)};
    paths.push_back(path);
  }
  return paths;
}

TEST(MarginShifts, DeliveryIsNearlyThatOfAPredictionAtTheOtherNoise) {
  for (const std::string name : {"micromodem-fsk", "micromodem-psk-5", "micromodem-psk-2", "janus"}) {
    const Modem modem = channel_server::load_modem(name).modem;
    const ReceptionCurves curves(modem, std::min<std::size_t>(32, max_payload_bytes(modem)));
    double squares = 0;
    constexpr int kPlaces = 100;
    for (std::uint32_t place = 0; place < kPlaces; ++place) {
      const std::vector<Arrival> paths = paths_of(place);
      const auto windows = likely_windows(paths, modem);
      const double noise = std::pow(10, 9.0 + 3.0 * uniform_at({.who = place}));
      const auto predicted = [&](double over, const MarginShifts& shifts) {
        return predict_link(kSea, paths, modem, windows, modem.band(), over, curves, shifts);
      };
      const MarginShifts shifts{-5, 6};
      const LinkPrediction now = predicted(noise, shifts), alone = predicted(noise, {});
      EXPECT_EQ(now.delivery_probability, alone.delivery_probability);
      EXPECT_EQ(alone.delivery_low, alone.delivery_probability);
      const double low = predicted(noise * std::pow(10, 0.5), {}).delivery_probability,
                   high = predicted(noise * std::pow(10, -0.6), {}).delivery_probability;
      EXPECT_LE(now.delivery_low, now.delivery_probability);
      EXPECT_LE(now.delivery_probability, now.delivery_high);
      EXPECT_NEAR(now.delivery_low, low, tolerance(0.1)) << name << " " << place;
      EXPECT_NEAR(now.delivery_high, high, tolerance(0.1)) << name << " " << place;
      squares += std::pow(now.delivery_low - low, 2) + std::pow(now.delivery_high - high, 2);
    }
    EXPECT_LT(std::sqrt(squares / (2 * kPlaces)), tolerance(0.015)) << name;
  }
}

}  // namespace
}  // namespace halocline::acoustics
