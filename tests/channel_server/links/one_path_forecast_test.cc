#include "channel_server/links/one_path_forecast.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/reception/guard_window.h"
#include "acoustics/reception/link_prediction.h"
#include "channel_server/modems/modem_config.h"
#include "core/elementary.h"
#include "core/random.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::tolerance;

constexpr acoustics::FadingModel kSea{.enabled = true};

std::vector<acoustics::SoundPath> one_path(double level_db) {
  acoustics::SoundPath path;
  path.delay_s = 0.7;
  path.level = Decibels{level_db};
  path.fading = path_fading(kSea, 7, 25'000, 0, 0);
  return {path};
}

// At ratios drawn at random, of every modem that is known.
TEST(OnePathForecast, IsThePredictionOfTheLink) {
  for (const std::string& name : built_in_modems()) {
    const acoustics::Modem modem = load_modem(name).modem;
    const acoustics::ReceptionCurves curves(modem, 32);
    const OnePathForecast forecast(kSea, curves);
    for (std::uint64_t i = 0; i < 200; ++i) {
      const double level_db = 60 + 80 * uniform_at({.seed = 5, .which = i}), noise = 1e9;
      const auto paths = one_path(level_db);
      const auto from_table = forecast.at(paths, noise);
      ASSERT_TRUE(from_table);
      const acoustics::LinkPrediction made =
          predict_link(kSea, paths, {&modem, best_window(paths, modem)}, modem.band(), noise, curves);
      EXPECT_NEAR(from_table->sinr / made.sinr, 1, 1e-6) << modem.family;
      EXPECT_NEAR(from_table->acquisition_probability, made.acquisition_probability, tolerance(1e-4));
      EXPECT_NEAR(from_table->delivery_probability, made.delivery_probability, tolerance(1e-4));
    }
  }
}

TEST(OnePathForecast, HoldsForOnePathThatHasNotBouncedAlone) {
  const acoustics::Modem modem;
  const OnePathForecast forecast(kSea, acoustics::ReceptionCurves(modem, 32));
  EXPECT_TRUE(forecast.at(one_path(90), 1e9));
  EXPECT_FALSE(forecast.at(one_path(20), 1e9));   // too weak
  EXPECT_FALSE(forecast.at(one_path(160), 1e9));  // too strong
  auto bounced = one_path(90);
  bounced.front().fading = path_fading(kSea, 7, 25'000, 0.01, 0);
  EXPECT_FALSE(forecast.at(bounced, 1e9));
  EXPECT_FALSE(forecast.at({one_path(90).front(), one_path(90).front()}, 1e9));
  EXPECT_FALSE(OnePathForecast({}, acoustics::ReceptionCurves(modem, 32)).at(one_path(90), 1e9));
}

}  // namespace
}  // namespace halocline::channel_server
