// SPDX-License-Identifier: BSD-3-Clause
// The bound on levels behind the reach against the levels that rays give, at places drawn at random in waters
// that spread sound least: shallow and deep, ducts at the surface, at depth and over the bottom, sand, gravel
// and rock, flat, sloping and wavy.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "acoustics/link/least_loss.h"
#include "acoustics/modem/modem.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "bus/config/scenario.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/detail.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/ray_propagation.h"
#include "core/elementary.h"
#include "core/random.h"
#include "core/units.h"
#include "tests/channel_server/channel_fixtures.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;

constexpr std::uint64_t kPlaces = 150;

struct Sea {
  const char* name;
  std::vector<acoustics::SpeedRow> speeds;  // profile; empty: the same everywhere
  double bottom_m;
  double slope = 0, waves_m = 0;     // of the bottom, of 300 m length
  double greatest_range_m = 10'000;  // searches over waves grow with range
  const char* sediment = "MediumSand";
  double frequency_hz = 25'000;
  bool fades = true;
};

double draw(std::uint64_t place, std::uint32_t what, double low, double high) {
  return low + (high - low) * uniform_at({.seed = 57, .who = what, .which = place});
}

enum class Bound { kMinLoss, kMinLossOfKnownDepths, kFluxOnlyLinks };

class LevelBound : public ::testing::TestWithParam<Sea> {
 protected:
  // Level over its bound, dB, at each place where anything arrives; of flux-only links, at each that is long
  // and weak.
  std::vector<double> excesses(Bound bound) const {
    const bool depths_are_known = bound != Bound::kMinLoss;
    const Sea& sea = GetParam();
    ChannelServerConfig config;
    config.propagation.sediment = sea.sediment;
    config.propagation.fading.enabled = sea.fades;
    config.environment.noise.wind_mps = 0;
    config.environment.profile.source = ProfileSource::kIsovelocity;
    acoustics::Environment water = make_environment(config.environment, bus::Scenario());
    if (!sea.speeds.empty())
      water.profile =
          acoustics::SoundSpeedProfile::from_speeds(sea.speeds, config.environment.profile.assumed);
    const auto waters = std::make_shared<EnvironmentTimeline>(water);
    RayModel rays = with_turned_seas(make_rays(config));
    acoustics::Modem modem;
    modem.centre_frequency_hz = sea.frequency_hz;
    modem.bandwidth_hz = sea.frequency_hz / 5;
    if (bound == Bound::kFluxOnlyLinks) {
      modem.source_level = Decibels{110};
      rays.options.diffuse_below_flux_db = kFastLevel.diffuse_below_flux_db;
      rays.diffuse_below_noise = kFastLevel.diffuse_below_noise;
      rays.weak_below_diffuse = kFastLevel.weak_below_diffuse;
    }
    std::vector<double> excesses;
    for (std::uint64_t place = 0; place < kPlaces; ++place) {
      const double range_m = elementary::exp10(draw(place, 1, 2, elementary::log10(sea.greatest_range_m)));
      const auto bottom_at = [&](double north_m) {
        return std::max(sea.bottom_m + sea.slope * north_m +
                            sea.waves_m * elementary::sin(2 * std::numbers::pi * north_m / 300),
                        3.0);
      };
      const Vec3 from(0, 0, draw(place, 2, 0.02, 0.98) * bottom_at(0));
      const Vec3 to(range_m, 0, draw(place, 3, 0.02, 0.98) * bottom_at(range_m));
      if (depths_are_known) {
        rays.least_depth_m = rays.greatest_depth_m = bottom_at(0);
        for (double north_m = 0; north_m <= range_m; north_m += range_m / 1000) {
          rays.least_depth_m = std::min(rays.least_depth_m, bottom_at(north_m));
          rays.greatest_depth_m = std::max(rays.greatest_depth_m, bottom_at(north_m));
        }
      }
      RayPropagation propagation(waters, testing::seabed_around(from, to, bottom_at), rays);
      const Reception reception =
          propagation.reception(at_s(1), {1, from, Vec3::Zero(), &modem}, {2, to, Vec3::Zero(), &modem});
      if (reception.paths.empty()) continue;
      const double deepest_m = std::max(from.z(), to.z());
      const Decibels level = reception.budget.received_level;
      if (bound != Bound::kFluxOnlyLinks) {
        const auto least = propagation.least_loss(at_s(1), modem.centre_frequency_hz, deepest_m);
        excesses.push_back((level - (modem.source_level - least->at(reception.budget.range_m))).value);
        continue;
      }
      const auto weak = propagation.flux_only_links(at_s(1), modem.centre_frequency_hz, deepest_m);
      const bool is_long = range_m >= 10 * rays.greatest_depth_m;
      if (is_long && level < reception.budget.noise_level - weak->below_noise)
        excesses.push_back((level - (modem.source_level - weak->loss.at(reception.budget.range_m))).value);
    }
    return excesses;
  }
};

TEST_P(LevelBound, HoldsAtRandomPlaces) {
  for (const Bound bound : {Bound::kMinLoss, Bound::kMinLossOfKnownDepths}) {
    const bool depths_are_known = bound != Bound::kMinLoss;
    const std::vector<double> all = excesses(bound);
    ASSERT_GT(all.size(), kPlaces / 10);
    const double greatest = *std::max_element(all.begin(), all.end());
    RecordProperty(depths_are_known ? "greatest_excess_known_db" : "greatest_excess_db",
                   fmt::format("{:.1f}", greatest));
    EXPECT_LT(greatest, 0) << (depths_are_known ? "depths are known" : "");
  }
}

// A run at Detail::kFast has flux-only links. Those in deep water are longer than the ones drawn.
TEST_P(LevelBound, OfFluxOnlyLinksHoldsAtRandomPlaces) {
  const std::vector<double> all = excesses(Bound::kFluxOnlyLinks);
  if (GetParam().bottom_m <= 100 && GetParam().waves_m == 0) {
    ASSERT_GT(all.size(), 4u);
  }
  for (const double excess : all) EXPECT_LT(excess, 0);
  if (!all.empty())
    RecordProperty("greatest_excess_db", fmt::format("{:.1f}", *std::max_element(all.begin(), all.end())));
}

INSTANTIATE_TEST_SUITE_P(
    Seas, LevelBound,
    ::testing::Values(Sea{"Creek", {}, 5}, Sea{"Shallow", {}, 15}, Sea{"Shelf", {}, 100},
                      Sea{"Deep", {}, 1500}, Sea{"Gravel", {}, 30, 0, 0, 10'000, "SandyGravel"},
                      Sea{"Rock", {}, 30, 0, 0, 10'000, "Rock"},
                      Sea{"SurfaceDuct", {{0, 1500}, {40, 1504}, {60, 1490}, {300, 1488}}, 300},
                      Sea{"ThinDuct", {{0, 1500}, {8, 1503}, {10, 1490}, {80, 1490}}, 80},
                      Sea{"Channel", {{0, 1510}, {60, 1500}, {80, 1480}, {100, 1500}, {400, 1508}}, 400},
                      Sea{"BottomDuct", {{0, 1520}, {50, 1500}, {100, 1495}}, 100},
                      Sea{"Upslope", {}, 150, -0.012}, Sea{"Downslope", {}, 8, 0.012},
                      Sea{"Waves", {}, 60, 0, 3, 1000},
                      Sea{"WithoutFading", {}, 100, 0, 0, 10'000, "MediumSand", 25'000, false},
                      Sea{"LowFrequency", {}, 100, 0, 0, 10'000, "MediumSand", 3'000}),
    [](const auto& parameter) { return std::string(parameter.param.name); });

}  // namespace
}  // namespace halocline::channel_server
