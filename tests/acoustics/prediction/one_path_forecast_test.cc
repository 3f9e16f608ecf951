// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/prediction/one_path_forecast.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/modem/error_model.h"
#include "acoustics/modem/modem.h"
#include "acoustics/prediction/link_prediction.h"
#include "acoustics/reception/guard_window.h"
#include "channel_server/modems/modem_config.h"
#include "core/elementary.h"
#include "core/random.h"
#include "core/units.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::tolerance;

constexpr acoustics::FadingModel kSea{.enabled = true};
constexpr double kNoise = 1e9;  // 90 dB

std::vector<acoustics::Arrival> one_path(double level_db) {
  acoustics::Arrival path;
  path.delay_s = 0.7;
  path.level = Decibels{level_db};
  path.fading = path_fading(kSea, 7, 25'000, 0, 0);
  return {path};
}

// At ratios drawn at random, of every modem that is known. Predictions of phase-shift keying of many bits
// jump by some hundredths here and there; between the ratios of the table those beside it hold.
TEST(OnePathForecast, IsThePredictionOfTheLink) {
  for (const std::string& name : built_in_modems()) {
    const acoustics::Modem modem = load_modem(name).modem;
    const acoustics::ReceptionCurves curves(modem, std::min<std::size_t>(32, max_payload_bytes(modem)));
    const OnePathForecast forecast(kSea, curves);
    const auto predicted = [&](double level_db) {
      const auto paths = one_path(level_db);
      return predict_link(kSea, paths, {&modem, best_window(paths, modem)}, modem.band(), kNoise, curves);
    };
    for (std::uint64_t i = 0; i < 200; ++i) {
      const double level_db = 62 + 76 * uniform_at({.seed = 5, .which = i});
      const auto from_table = forecast.at(one_path(level_db), kNoise);
      ASSERT_TRUE(from_table);
      const acoustics::LinkPrediction here = predicted(level_db);
      EXPECT_NEAR(from_table->sinr / here.sinr, 1, 1e-6) << name;
      EXPECT_NEAR(from_table->acquisition_probability, here.acquisition_probability, tolerance(5e-4)) << name;
      const double step_db = OnePathForecast::kStepDb, low_db = step_db * std::floor(level_db / step_db);
      std::vector<double> near{here.delivery_probability};
      for (int k = -1; k <= 2; ++k) near.push_back(predicted(low_db + k * step_db).delivery_probability);
      const auto [least, most] = std::minmax_element(near.begin(), near.end());
      const double margin =
          (*most - *least) / 8 + tolerance(5e-4);  // by which a cubic may go beyond its points
      EXPECT_GT(from_table->delivery_probability, *least - margin) << name;
      EXPECT_LT(from_table->delivery_probability, *most + margin) << name;
      if (is_frequency_shift_keying(modem.error_model)) {
        EXPECT_NEAR(from_table->delivery_probability, here.delivery_probability, tolerance(5e-4)) << name;
      }
    }
  }
}

TEST(OnePathForecast, HoldsForOnePathThatHasNotBouncedAlone) {
  const acoustics::Modem modem;
  const OnePathForecast forecast(kSea, acoustics::ReceptionCurves(modem, 32));
  EXPECT_TRUE(forecast.at(one_path(90), kNoise));
  EXPECT_FALSE(forecast.at(one_path(59), kNoise));   // too weak
  EXPECT_FALSE(forecast.at(one_path(141), kNoise));  // too strong
  auto bounced = one_path(90);
  bounced.front().fading = path_fading(kSea, 7, 25'000, 0.01, 0);
  EXPECT_FALSE(forecast.at(bounced, kNoise));
  EXPECT_FALSE(forecast.at({one_path(90).front(), one_path(90).front()}, kNoise));
  EXPECT_FALSE(OnePathForecast({}, acoustics::ReceptionCurves(modem, 32)).at(one_path(90), kNoise));
}

}  // namespace
}  // namespace halocline::channel_server
