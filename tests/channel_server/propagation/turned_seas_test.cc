// SPDX-License-Identifier: BSD-3-Clause
// Turned sound over the paths of links.
#include "channel_server/propagation/turned_seas.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/fading/arrival.h"
#include "acoustics/modem/modem.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/scattering/angle_transport.h"
#include "acoustics/scattering/transport_end.h"
#include "acoustics/scattering/turned_sound.h"
#include "acoustics/sea/profile_drift.h"
#include "acoustics/sea/ray_water.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "acoustics/sea/surface/surface_boundary.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/ray_propagation.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/propagation/seabed_profile.h"
#include "core/units.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::tolerance;
using testing::at_s;

// A level sea of one speed of sound, or of the speeds given.
struct TurningSea {
  double depth_m = 20, wind_mps = 5, frequency_hz = 25'000;
  const char* sediment = "MediumSand";
  std::vector<acoustics::SpeedRow> speeds = {};
  bool turns = true;

  RayPropagation propagation() const {
    acoustics::Environment environment;
    environment.profile = speeds.empty() ? acoustics::SoundSpeedProfile::isovelocity(1500, {10, 35})
                                         : acoustics::SoundSpeedProfile::from_speeds(speeds, {10, 35});
    environment.noise.wind_mps = wind_mps;
    RayModel model;
    model.bounces_follow_range = true;
    model.options.max_bounces = 0;
    model.bottom = *acoustics::sediment(sediment);
    model.fading.enabled = true;
    model.fading.turns = turns;
    model.fading.bottom_roughness_m = 0.03;
    return {std::make_shared<EnvironmentTimeline>(environment), std::make_shared<SeabedMap>(SeabedRule{}),
            model};
  }
  acoustics::Modem modem() const {
    acoustics::Modem modem;
    modem.centre_frequency_hz = frequency_hz;
    return modem;
  }
};

Reception over_level(const TurningSea& sea, RayPropagation& propagation, double range_m, double from_m,
                     double to_m) {
  const acoustics::Modem modem = sea.modem();
  return propagation.reception_over(at_s(0), {0, {0, 0, from_m}, Vec3::Zero(), &modem},
                                    {0, {range_m, 0, to_m}, Vec3::Zero(), &modem},
                                    std::make_shared<const SeabedProfile>(SeabedProfile::flat(sea.depth_m)));
}

// Loss by the powers of all paths, without their interference, less spherical spreading and absorption.
double beyond_spherical_db(const TurningSea& sea, RayPropagation& propagation, double range_m, double from_m,
                           double to_m) {
  const Reception reception = over_level(sea, propagation, range_m, from_m, to_m);
  const double loss_db = (sea.modem().source_level - total_level(reception.paths)).value;
  return loss_db - 20 * std::log10(range_m) - reception.budget.absorption_db_per_km * range_m / 1000;
}

// The oracle of 20 m of medium sand at 25 kHz, 2 km: 11.1, 5.5 and 2.9 dB below spherical for winds of 2, 5
// and 10 m/s; rays scattered one by one have 3.3 at 10 m/s.
TEST(TurnedSeas, GetWeakerWithTheWindAsTheOracleDoes) {
  for (const auto& [wind_mps, below_db] : {std::pair(2.0, 11.1), {5.0, 5.5}, {10.0, 2.9}}) {
    const TurningSea sea{.wind_mps = wind_mps};
    RayPropagation propagation = sea.propagation();
    EXPECT_NEAR(beyond_spherical_db(sea, propagation, 2000, 10, 10), -below_db, tolerance(0.5)) << wind_mps;
  }
}

// Even water of many depths, winds, sediments and ranges: between spherical spreading and 9.5 dB below, 4 dB
// below in the middle.
TEST(TurnedSeas, KeepWithinSphericalSpreadingAndTenDecibelsBelow) {
  std::vector<double> all;
  for (const double depth_m : {15.0, 40.0, 100.0}) {
    for (const double wind_mps : {5.0, 10.0}) {
      for (const char* sediment : {"MediumSand", "VeryFineSand", "SandySilt"}) {
        for (const double khz : {10.0, 25.0}) {
          const TurningSea sea{depth_m, wind_mps, 1000 * khz, sediment};
          RayPropagation propagation = sea.propagation();
          for (const double range_m : {500.0, 1600.0, std::min(5000.0, 60 * depth_m)})
            all.push_back(beyond_spherical_db(sea, propagation, range_m, depth_m / 2, 0.6 * depth_m));
        }
      }
    }
  }
  std::sort(all.begin(), all.end());
  EXPECT_GT(all.front(), -9.5);
  EXPECT_LT(all.back(), 0.5);
  EXPECT_NEAR(all[all.size() / 2], -4, 1.5);
}

TEST(TurnedSeas, AreTheSameFromEitherEnd) {
  const TurningSea sea{
      100, 5, 25'000, "MediumSand", {{0, 1526}, {15, 1526.3}, {30, 1507}, {50, 1501}, {100, 1501.8}}};
  RayPropagation propagation = sea.propagation();
  const double there_db = total_level(over_level(sea, propagation, 1500, 10, 60).paths).value;
  const double back_db = total_level(over_level(sea, propagation, 1500, 60, 10).paths).value;
  EXPECT_NEAR(there_db, back_db, tolerance(1e-6));
}

// Transports are cached by what they depend on: what was asked before changes nothing.
TEST(TurnedSeas, DoNotDependOnTheOrderOfQueries) {
  const TurningSea sea;
  RayPropagation fresh = sea.propagation(), used = sea.propagation();
  for (double depth_m = 1; depth_m < 19; depth_m += 0.7) over_level(sea, used, 700, depth_m, 11.3);
  const Reception first = over_level(sea, fresh, 1234, 9.1, 11.3),
                  later = over_level(sea, used, 1234, 9.1, 11.3);
  ASSERT_EQ(first.paths.size(), later.paths.size());
  for (std::size_t i = 0; i < first.paths.size(); ++i) {
    EXPECT_EQ(first.paths[i].delay_s, later.paths[i].delay_s);
    EXPECT_EQ(first.paths[i].level.value, later.paths[i].level.value);
  }
}

// A bounced path keeps its coherent share; the direct one and those of one bounce keep all.
TEST(TurnedSeas, LeaveTracedPathsOfSeveralBouncesTheirCoherentShare) {
  const TurningSea sea{.wind_mps = 4}, same{.wind_mps = 4, .turns = false};
  RayPropagation turning = sea.propagation(), keeping = same.propagation();
  const Reception turned = over_level(sea, turning, 800, 10, 12),
                  kept = over_level(same, keeping, 800, 10, 12);
  int compared = 0;
  for (const Arrival& path : turned.paths) {
    if (path.diffuse) continue;
    const auto other = std::find_if(kept.paths.begin(), kept.paths.end(),
                                    [&](const Arrival& one) { return one.identity == path.identity; });
    ASSERT_NE(other, kept.paths.end());
    const bool several = path.surface_bounces + path.bottom_bounces > 1;
    const double lost_db = (other->level - path.level).value;
    EXPECT_NEAR(lost_db, several ? -10 * std::log10(1 - other->fading.scattered) : 0, 1e-6);
    if (several) EXPECT_NEAR(path.fading.scattered, 0, 1e-9);
    ++compared;
  }
  EXPECT_GT(compared, 4);
}

TEST(TurnedSeas, FadeFullyInTheirWindows) {
  const TurningSea sea{.wind_mps = 8};
  RayPropagation propagation = sea.propagation();
  const Reception reception = over_level(sea, propagation, 400, 10, 10);
  int windows = 0;
  for (const Arrival& path : reception.paths) {
    if (!path.diffuse) continue;
    ++windows;
    EXPECT_EQ(path.fading.scattered, 1);
    EXPECT_GT(path.fading.doppler_spread_hz, 0);
  }
  EXPECT_GT(windows, 4);
  EXPECT_LE(windows, 16);
}

// Warm water on top bends all direct sound down: the first path is one of a bounce, and no window of turned
// sound comes before it.
TEST(TurnedSeas, ComeAfterTheFirstPath) {
  const TurningSea sea{
      90, 5, 25'000, "MediumSand", {{0, 1508}, {5, 1506}, {10, 1490}, {20, 1483}, {90, 1480}}};
  RayPropagation propagation = sea.propagation();
  const Reception reception = over_level(sea, propagation, 850, 5, 10);
  ASSERT_FALSE(reception.paths.empty());
  EXPECT_FALSE(reception.paths.front().diffuse);
  EXPECT_GT(reception.paths.front().bottom_bounces, 0);
  EXPECT_TRUE(std::any_of(reception.paths.begin(), reception.paths.end(),
                          [](const Arrival& path) { return path.diffuse; }));
}

// Power of the turned sound of a link of 1500 m over even water, 40 m deep less `rise_m` of the place.
double turned_power(const TurnedSeas& seas, const std::function<double(std::size_t)>& rise_m) {
  const acoustics::RayWater water({{0, 1500}, {100, 1500}}, [](double) { return 5.0; });
  acoustics::FadingModel fading;
  fading.enabled = fading.turns = true;
  TurnedLink link{water,
                  *acoustics::sediment("MediumSand"),
                  {acoustics::SurfaceModel::kAplBubbles, 5},
                  fading,
                  25'000,
                  {10, 10, 1500},
                  {},
                  0};
  for (std::size_t i = 0; i < link.depths_m.size(); ++i) link.depths_m[i] = 40 - rise_m(i);
  double power = 0;
  for (const acoustics::Eigenray& window : seas.windows_alone(link))
    power += window.received_pressure() * window.received_pressure();
  return power;
}

// The turned sound of a slope changes by less than 1 dB where a stretch enters the next depth, and lies
// between those of its ends.
TEST(TurnedSeas, ChangeSmoothlyWithTheDepthAlongALink) {
  const TurnedSeas seas;
  double before_db = 0;
  for (double slope_m = 0; slope_m < 10; slope_m += 0.1) {
    const auto slope = [&](std::size_t i) { return slope_m * (static_cast<double>(i) + 0.5) / 16; };
    const double loss_db = -10 * std::log10(turned_power(seas, slope));
    if (slope_m > 0) EXPECT_NEAR(loss_db, before_db, 1) << slope_m;
    before_db = loss_db;
  }
}

// Steps between stretches mix bins, which costs sound. Depths alike to 10 % are one stretch, so the loss over
// gentle relief lies between those of the level seas; with a step at each eighth it was 1.4 to 2.8 dB above.
TEST(TurnedSeas, LoseOverGentleReliefWhatTheyLoseOverItsDepths) {
  const acoustics::RayWater water({{0, 1525}, {15, 1525}, {30, 1508}, {50, 1502}, {200, 1504}},
                                  [](double) { return 5.0; });
  acoustics::FadingModel fading;
  fading.enabled = fading.turns = true;
  const TurnedSeas seas;
  for (const double range_m : {700.0, 1500.0, 3000.0}) {
    const auto loss_db = [&](double even_m, double odd_m) {
      TurnedLink link{water,
                      *acoustics::sediment("MediumSand"),
                      {acoustics::SurfaceModel::kAplBubbles, 5},
                      fading,
                      25'000,
                      {42, 57, range_m}};
      for (std::size_t i = 0; i < link.depths_m.size(); ++i)
        link.depths_m[i] = (i / 2) % 2 == 0 ? even_m : odd_m;
      double power = 0;
      for (const acoustics::Eigenray& window : seas.windows_alone(link))
        power += window.received_pressure() * window.received_pressure();
      return -10 * std::log10(power);
    };
    const double level_db = loss_db(100, 100), deeper_db = loss_db(105, 105);
    const double relief_db = loss_db(100, 105);
    EXPECT_GT(relief_db, std::min(level_db, deeper_db) - tolerance(0.2)) << range_m;
    EXPECT_LT(relief_db, std::max(level_db, deeper_db) + tolerance(0.2)) << range_m;
  }
}

// A tide over a level bottom shares transports: depths count to three digits, scaled to the depth itself, and
// the wind counts to 0.1 m/s.
TEST(TurnedSeas, ChangeHardlyWithDepthsAndWindsThatShareATransport) {
  const acoustics::RayWater water({{0, 1506}, {8, 1503}, {40, 1501}}, [](double) { return 5.0; });
  acoustics::FadingModel fading;
  fading.enabled = fading.turns = true;
  const TurnedSeas seas;
  const auto loss_db = [&](double depth_m, double wind_mps) {
    TurnedLink link{water,
                    *acoustics::sediment("MediumSand"),
                    {acoustics::SurfaceModel::kAplBubbles, wind_mps},
                    fading,
                    25'000,
                    {6, 9, 1500}};
    link.depths_m.fill(depth_m);
    double power = 0;
    for (const acoustics::Eigenray& window : seas.windows_alone(link))
      power += window.received_pressure() * window.received_pressure();
    return -10 * std::log10(power);
  };
  double before_db = loss_db(20, 5);
  for (double depth_m = 20.01; depth_m < 20.3; depth_m += 0.01) {
    const double one_db = loss_db(depth_m, 5);
    EXPECT_NEAR(one_db, before_db, tolerance(0.05)) << depth_m;
    before_db = one_db;
  }
  EXPECT_EQ(loss_db(20, 5.04), loss_db(20, 5));
  EXPECT_NEAR(loss_db(20, 5.06), loss_db(20, 5.04), tolerance(0.2));
}

// A ridge in the middle of a link lets less and less sound pass as it rises; from 39.9 m on, as land,
// none. Scenario relay had 62 dB through its island.
TEST(TurnedSeas, DoNotPassThroughLand) {
  const TurnedSeas seas;
  const auto behind = [&](double ridge_m) {
    return turned_power(seas, [&](std::size_t i) { return i == 7 ? ridge_m : 0; });
  };
  double before = behind(30);
  EXPECT_GT(before, 0);
  for (const double ridge_m : {36.0, 38.0, 39.0, 39.5, 39.8}) {
    const double power = behind(ridge_m);
    EXPECT_LT(power, before) << ridge_m;
    EXPECT_GT(power, 0) << ridge_m;
    before = power;
  }
  EXPECT_EQ(behind(40 - kMinWaterM / 2), 0);
}

// 12 m of sandy mud whose water drifts by 0.3 m/s, 25 kHz, wind 5 m/s.
class DriftingHarbour : public ::testing::Test {
 protected:
  static constexpr double kDepthM = 12, kEndM = 6, kFrequencyHz = 25'000;

  acoustics::RayWater water_of(std::uint64_t member) const {
    acoustics::Environment environment;
    environment.profile = acoustics::SoundSpeedProfile::from_water(
        {{0, 12, 30}, {kDepthM, 12, 30}}, acoustics::SoundSpeedModel::kMackenzie1981, 0);
    const acoustics::ProfileDrift drift{.spread_mps = 0.3, .depth_m = kDepthM, .seed = member};
    environment.profile =
        environment.profile.with_change(drift_rows(kDepthM, acoustics::drift_amplitudes(drift, 0)));
    return ray_water(environment, kFrequencyHz, 0);
  }
  TurnedLink link_of(const acoustics::RayWater& water, double range_m) const {
    TurnedLink link{water, bottom_, surface_, fading_, kFrequencyHz, {kEndM, kEndM, range_m}, {}, 0, medium_};
    link.depths_m.fill(kDepthM);
    return link;
  }
  // Traced paths, before anything of them is scattered.
  std::vector<acoustics::Eigenray> traced(const acoustics::RayWater& water, double range_m) const {
    acoustics::RayOptions options;
    options.frequency_hz = kFrequencyHz;
    options.max_bounces = bounces_for(range_m, kDepthM);
    options.fine_structure = medium_;
    const acoustics::RaySea sea{water, acoustics::BottomProfile::flat(kDepthM), bottom_, surface_, options};
    return eigenrays(sea, {kEndM, kEndM, range_m}).paths;
  }
  // All sound of the transport, bounced or not, the mean of both directions.
  double transported(const TurnedLink& link) const {
    acoustics::TransportSea sea{
        link.water, kDepthM, kFrequencyHz, acoustics::scattering_surface(link.surface, kFrequencyHz),
        acoustics::rough_bottom(link.bottom, link.water.speed_at(kDepthM), link.fading.bottom_roughness_m,
                                link.fading.bottom_slope * link.fading.bottom_slope)};
    for (const double gradient : link.water.gradients_per_s())
      sea.speed_deviation_mps.push_back(std::sqrt(link.medium.speed_variance(gradient)));
    const acoustics::AngleTransport transport(sea);
    const acoustics::TransportEnd end(transport, kEndM);
    const acoustics::TurnedSound sound = turned_sound(transport, end, end, link.link.range_m);
    return sound.power + sound.unbounced;
  }
  // What arrives by the paths: of bounced ones that are traced the coherent share.
  double power_of(const std::vector<acoustics::Eigenray>& paths) const {
    const double waves_m = surface_boundary(surface_.wind_mps, surface_.ice, kFrequencyHz).rms_height_m;
    double power = 0;
    for (const acoustics::Eigenray& path : paths) {
      const bool keeps_all = path.diffuse || path.surface_bounces + path.bottom_bounces < 2;
      power += path.received_pressure() * path.received_pressure() *
               (keeps_all ? 1
                          : acoustics::coherent_share(fading_, waves_m, kFrequencyHz,
                                                      path.surface_sine_squares, path.bottom_sine_squares));
    }
    return power;
  }

  const acoustics::FluidBottom bottom_ = *acoustics::sediment("SandyMud");
  const acoustics::RaySurface surface_{acoustics::SurfaceModel::kAplBubbles, 5};
  const acoustics::FineStructure medium_{0.05, 0.5};
  acoustics::FadingModel fading_{.enabled = true, .bottom_roughness_m = 0.03, .turns = true};
  const TurnedSeas seas_;
};

// Drawn profiles focus few grazing paths up to 50 dB above the transport's total at 8 km. Fine structure
// spreads their rays over the whole depth from 3 km on, where no focus survives it. At 2 km a hundredth does
// of one 19 dB above the total, and with it that lies 4.6 dB above.
TEST_F(DriftingHarbour, FocusesNoMoreThanTwiceTheSoundOfTheTransport) {
  for (const double range_m : {2000.0, 4000.0, 8000.0}) {
    double most_traced_db = -100, most_db = -100;
    for (std::uint64_t member = 0; member < 30; ++member) {
      const acoustics::RayWater water = water_of(member);
      const TurnedLink link = link_of(water, range_m);
      const std::vector<acoustics::Eigenray> paths = traced(water, range_m);
      const double total = transported(link);
      most_traced_db = std::max(most_traced_db, 10 * std::log10(power_of(paths) / total));
      most_db = std::max(most_db, 10 * std::log10(power_of(seas_.with_turned_sound(link, paths)) / total));
    }
    EXPECT_GT(most_traced_db, 9) << range_m << " m";
    EXPECT_LT(most_db, 3.01 + (range_m > 3000 ? 0.05 : 2)) << range_m << " m";
  }
}

// What survives of a focus changes smoothly over the ranges in which fine structure comes to spread it.
TEST_F(DriftingHarbour, LosesItsFocusesSmoothlyWithRange) {
  const acoustics::RayWater water = water_of(24);
  double before_db = 0;
  for (double range_m = 1500; range_m < 1600; range_m += 1) {
    const auto paths = seas_.with_turned_sound(link_of(water, range_m), traced(water, range_m));
    const double db = 10 * std::log10(power_of(paths));
    if (range_m > 1500) {
      EXPECT_NEAR(db, before_db, 1) << range_m << " m";
    }
    before_db = db;
  }
}

}  // namespace
}  // namespace halocline::channel_server
