// SPDX-License-Identifier: BSD-3-Clause
// What surface and bottom do to a link.
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "acoustics/fading/link_fading.h"
#include "acoustics/fading/path_fading.h"
#include "acoustics/modem/modem.h"
#include "acoustics/prediction/platform_jitter.h"
#include "acoustics/prediction/steady_band.h"
#include "acoustics/reception/guard_window.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "bus/config/scenario.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/modems/modem_config.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/ray_propagation.h"
#include "core/units.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/support/doc_table.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;

// Between two vehicles at rest over a level bottom in water of one speed.
struct LevelSea {
  double depth_m = 0, wind_mps = 0;
  const char* sediment = "MediumSand";
  double roughness_m = acoustics::FadingModel().bottom_roughness_m;
  bool turns = false;

  Reception reception(const acoustics::Modem& modem, const Vec3& from, const Vec3& to) const {
    ChannelServerConfig config;
    config.environment.profile.source = ProfileSource::kIsovelocity;
    config.environment.noise.wind_mps = wind_mps;
    config.propagation.sediment = sediment;
    config.propagation.fading.bottom_roughness_m = roughness_m;
    config.propagation.fading.turns = turns;
    const auto water = make_environment(config.environment, bus::Scenario());
    RayPropagation propagation(std::make_shared<EnvironmentTimeline>(water),
                               testing::seabed_around(from, to, [&](double) { return depth_m; }),
                               make_rays(config));
    return propagation.reception(at_s(1), {1, from, Vec3::Zero(), &modem}, {2, to, Vec3::Zero(), &modem});
  }
};

// A buoy at 0.3 m, 11.5 kHz, over 500 m of clay: |sum of P^(1/2) exp(j phase)|^2 of the direct path and its
// mirror image is 4 sin^2(k z1 z2 / r) P, k z1 z2 / r = 0.145 at 3 km: 13.8 dB below the sum of the powers.
// Both ends move vertically by J = 0.2 m rms, which raises the mean of (z1 z2)^2 to (z1^2 + J^2)(z2^2 + J^2),
// by 1.6 dB.
TEST(LloydsMirror, LeavesABuoyJustBelowACalmSurfaceItsCoherentLevel) {
  acoustics::Modem modem = load_modem("generic").modem;
  modem.centre_frequency_hz = 11'500;
  const LevelSea sea{.depth_m = 500, .sediment = "Clay"};
  for (double range_m = 2950; range_m <= 3050; range_m += 7.3) {
    const Reception reception = sea.reception(modem, {0, 0, 0.3}, {range_m, 0, 30});
    const double wave_number = 2 * std::numbers::pi * 11'500 / 1500, slant_m = std::hypot(range_m, 30);
    const double one = to_power_ratio(reception.paths.front().level).value;
    const double buoy_m = std::hypot(0.3, acoustics::kPlatformJitterM);
    const double deep_m = std::hypot(30, acoustics::kPlatformJitterM);
    const double mirrored =
        to_decibels({4 * std::pow(std::sin(wave_number * buoy_m * deep_m / slant_m), 2) * one}).value;
    EXPECT_NEAR(reception.budget.received_level.value, mirrored, 0.5) << range_m << " m";
    EXPECT_GT(total_level(reception.paths).value - mirrored, 11.5) << range_m << " m";
  }
}

struct Losses {
  double mean_db = 0, window_db = 0, spherical_db = 0;
};

Losses losses_at_2_km(const LevelSea& sea, const char* profile) {
  const acoustics::Modem modem = load_modem(profile).modem;
  const Reception reception = sea.reception(modem, {0, 0, 6}, {2000, 0, 13});
  const acoustics::GuardWindow window = best_window(reception.paths, modem);
  Losses losses;
  losses.mean_db = reception.budget.transmission_loss.value;
  losses.window_db = modem.source_level.value - to_decibels({mean_signal(reception.paths, window)}).value;
  losses.spherical_db = 20 * std::log10(2000) + 2 * reception.budget.absorption_db_per_km;
  return losses;
}

// 20 m of water at 25 kHz, whose loss would be 76 dB by spherical spreading and absorption. Smooth and rough,
// surface and bottom return every path: 60.4 dB in calm; bubbles take their share. Where scattered sound
// turns, steep sound is lost at the bottom, and the loss comes within 9.5 dB of spherical.
TEST(ShallowWater, LosesBySpreadingBubblesAndWhatRoughBoundariesTurn) {
  struct Case {
    const char *wind, *scattering;
    LevelSea sea;
    double least_db, most_db;
  };
  const std::vector<Case> cases{{"0", "none", {.depth_m = 20}, 59.9, 60.9},
                                {"5", "none", {.depth_m = 20, .wind_mps = 5}, 64.2, 65.2},
                                {"0", "turns", {.depth_m = 20, .turns = true}, 60.5, 67},
                                {"5", "turns", {.depth_m = 20, .wind_mps = 5, .turns = true}, 66.5, 76},
                                {"5",
                                 "turns, sandy mud",
                                 {.depth_m = 20, .wind_mps = 5, .sediment = "SandyMud", .turns = true},
                                 68,
                                 76}};
  for (const Case& c : cases) {
    const Losses losses = losses_at_2_km(c.sea, "micromodem-fsk");
    halocline::testing::doc_row(
        "shallow", {c.wind, c.scattering, fmt::format("{:.1f}", losses.mean_db),
                    fmt::format("{:.1f}", losses.window_db), fmt::format("{:.1f}", losses.spherical_db)});
    EXPECT_GT(losses.mean_db, c.least_db) << c.wind << c.scattering;
    EXPECT_LT(losses.mean_db, c.most_db) << c.wind << c.scattering;
  }
}

TEST(ShallowWater, BouncesFollowRangeOverDepth) {
  EXPECT_EQ(bounces_for(1000, 100), 60);
  EXPECT_EQ(bounces_for(2000, 20), 60);
  EXPECT_EQ(bounces_for(3000, 2.5), 720);
  EXPECT_EQ(bounces_for(1e9, 1), 10'000);
}

}  // namespace
}  // namespace halocline::channel_server
