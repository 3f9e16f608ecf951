// SPDX-License-Identifier: BSD-3-Clause
// Losses of links in the sea as it is by default: bounds that energy and trials set. What changes by the hour
// is stilled; levels are those of the paths' powers, without their interference.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "acoustics/sea/boundary_reflection.h"
#include "channel_server/modems/modem_config.h"
#include "channel_server/propagation/propagation.h"
#include "core/units.h"
#include "simulation/composition.h"
#include "simulation/ensemble/sea_member.h"
#include "simulation/link_survey.h"
#include "tests/simulation/plain_seas.h"

namespace halocline::clients {
namespace {

using channel_server::VehicleModem;
using halocline::testing::link_over;
using halocline::testing::PlainSea;

VehicleModem modem_at(double frequency_hz) {
  VehicleModem modem;
  modem.modem.centre_frequency_hz = frequency_hz;
  return modem;
}

double loss_db(const LinkSurvey& link, const VehicleModem& modem) {
  return (modem.modem.source_level - channel_server::total_level(link.reception.paths)).value;
}

ScenarioConfig stilled(ScenarioConfig config) {
  still_the_hours(config.channel_server);
  return config;
}

ScenarioConfig trial(const std::string& name, const std::vector<std::string>& settings) {
  return stilled(
      load_scenario(HALOCLINE_SOURCE_DIR "/studies/trials/" + name + ".toml", settings, ScenarioUse::kWater));
}

// The link of a trial from a range to its receiver, both ends at one depth.
LinkSurvey trial_link(const ScenarioConfig& config, double range_m, double depth_m) {
  return survey_link(config, link_end(config, fmt::format("{},0,{}", range_m, depth_m)),
                     link_end(config, fmt::format("0,0,{}", depth_m)));
}

// Water of one speed.
PlainSea even_sea(double depth_m, double wind_mps, const std::string& sediment) {
  return {"even", depth_m, depth_m / 2, "", sediment, wind_mps};
}

// Losses beyond spherical spreading and absorption at these ranges, dB.
std::vector<double> beyond_spherical_db(const PlainSea& sea, double frequency_hz,
                                        const std::vector<double>& ranges_m) {
  const ScenarioConfig config = stilled(sea.scenario());
  const VehicleModem modem = modem_at(frequency_hz);
  std::vector<double> losses;
  for (const double range_m : ranges_m) {
    const LinkSurvey link = link_over(config, range_m, sea.depth_m / 2, 0.6 * sea.depth_m, modem);
    losses.push_back(loss_db(link, modem) - 20 * std::log10(range_m) -
                     link.reception.budget.absorption_db_per_km * range_m / 1000);
  }
  return losses;
}

// The mean of a value of the links of an ensemble of profiles, 0.3 m/s in each of two modes.
template <class Value>
double ensemble_mean(ScenarioConfig config, const Value& value_in) {
  constexpr std::size_t kMembers = 25;
  constexpr double kSpreadMps = 0.3;
  config.channel_server.environment.profile_modes_depth_m = config.terrain.flat.depth_m;
  double sum = 0;
  for (std::size_t i = 0; i < kMembers; ++i) {
    const MemberDraws draws = draws_of(1, i, kMembers);
    config.channel_server.environment.profile_modes = {kSpreadMps * draws.first_mode,
                                                       kSpreadMps * draws.second_mode};
    sum += value_in(config);
  }
  return sum / kMembers;
}

// The loss of the ensemble's mean power between two ends of one depth.
double mean_loss_db(const ScenarioConfig& config, double range_m, double depth_m, const VehicleModem& modem) {
  return -10 * std::log10(ensemble_mean(config, [&](const ScenarioConfig& member) {
    return std::pow(10, -loss_db(link_over(member, range_m, depth_m, depth_m, modem), modem) / 10);
  }));
}

// From near the surface down to a vehicle near the bottom of the deep sea: the direct path, its surface image
// beside it and echoes off the silt. Turned sound that filled the depth at once made it 21 dB louder.
TEST(SteepLinks, HaveTheLossOfTheirDirectSound) {
  const PlainSea& deep = halocline::testing::plain_seas()[5];
  const ScenarioConfig config = stilled(deep.scenario());
  const VehicleModem modem = modem_at(25e3);
  for (const double range_m : {1.0, 50.0, 200.0, 1000.0, 3000.0, 4500.0, 6000.0}) {
    const LinkSurvey link = link_over(config, range_m, 60, 2900, modem);
    const double slant_m = std::hypot(range_m, 2840);
    const double beyond_db = loss_db(link, modem) - 20 * std::log10(slant_m) -
                             link.reception.budget.absorption_db_per_km * slant_m / 1000;
    EXPECT_GT(beyond_db, -6) << range_m;
    EXPECT_LT(beyond_db, 1) << range_m;
  }
}

// 0.5 to 5 km and up to 60 depths. A sea whose sound stays at its angles lies up to 20 dB below.
TEST(EvenWater, LosesLittleLessThanSphericalSpreading) {
  std::vector<double> all;
  for (const double depth_m : {15.0, 40.0, 100.0}) {
    std::vector<double> ranges_m;
    for (const double range_m : {500.0, 900.0, 1600.0, 2800.0, 5000.0})
      if (range_m <= 60 * depth_m) ranges_m.push_back(range_m);
    for (const double wind_mps : {5.0, 10.0}) {
      for (const char* sediment : {"MediumSand", "VeryFineSand", "SandySilt", "MediumSilt"}) {
        for (const double frequency_hz : {10e3, 25e3}) {
          const auto losses =
              beyond_spherical_db(even_sea(depth_m, wind_mps, sediment), frequency_hz, ranges_m);
          all.insert(all.end(), losses.begin(), losses.end());
        }
      }
    }
  }
  std::sort(all.begin(), all.end());
  EXPECT_GT(all.front(), -9.5);
  EXPECT_LT(all.back(), 0);
  EXPECT_NEAR(all[all.size() / 2], -4, 1);
}

// In a calm sound keeps its angles for longer: to 13 km, at 25 kHz, it lies less than 16.5 dB below.
TEST(EvenWater, CarriesNoFurtherThanItsEnergyInACalm) {
  for (const double depth_m : {15.0, 40.0, 100.0}) {
    for (const char* sediment : {"MediumSand", "VeryFineSand", "SandySilt"}) {
      const std::vector<double> ranges_m{500, 1000, 2000, 4000, 8000, 13'000};
      for (const double loss : beyond_spherical_db(even_sea(depth_m, 2, sediment), 25e3, ranges_m))
        EXPECT_GT(loss, -16.5) << depth_m << " " << sediment;
    }
  }
  // So does the mean of drawn profiles; one of them may focus paths by some decibels.
  const PlainSea shallow = even_sea(15, 2, "MediumSand");
  const double range_m = 13'000, spherical_db = 20 * std::log10(range_m);
  const VehicleModem modem = modem_at(25e3);
  const ScenarioConfig config = stilled(shallow.scenario());
  const double absorbed_db =
      link_over(config, range_m, shallow.end_m, shallow.end_m, modem).reception.budget.absorption_db_per_km *
      range_m / 1000;
  EXPECT_GT(mean_loss_db(config, range_m, shallow.end_m, modem), spherical_db + absorbed_db - 16.5);
}

// A surface 0.1 degC colder to 0.3 degC warmer than the bottom, which no thermometer tells apart, moves the
// loss of a perfect still sea by 19 dB at 2 km.
TEST(TropicalWater, LosesByItsEnsembleNotByAProfile) {
  const VehicleModem modem = modem_at(25e3);
  double least_db = 1e9, most_db = 0;
  for (const double warmer : {-0.1, 0.0, 0.1, 0.2, 0.3}) {
    const PlainSea sea{
        "tropic", 15, 7.5, fmt::format("[[0.0, {}, 32.0], [15.0, 29.0, 32.0]]", 29 + warmer), "SandySilt", 8};
    const ScenarioConfig config = stilled(sea.scenario());
    double weakest_db = 0;
    for (const double range_m : {300.0, 500.0, 800.0, 1300.0, 2000.0, 3200.0, 5000.0}) {
      const double loss = mean_loss_db(config, range_m, sea.end_m, modem);
      EXPECT_GT(loss, weakest_db - 2) << warmer << " " << range_m;
      weakest_db = std::max(weakest_db, loss);
      if (range_m != 2000) continue;
      least_db = std::min(least_db, loss);
      most_db = std::max(most_db, loss);
    }
  }
  EXPECT_LT(most_db - least_db, 6);
}

// Rays that turn at the receiver's depth focus: 1520 to 1510 m/s over 100 m of water above rock, both ends at
// 60 m. A still sea without fine structure has 20 dB more at 2200 m than beside it.
TEST(Cusp, IsNoFocusOfALink) {
  const PlainSea sea{"cusp", 100, 60, "[[0.0, 19.473, 35.0], [100.0, 15.534, 35.0]]", "Rock"};
  const ScenarioConfig config = stilled(sea.scenario());
  const VehicleModem modem = modem_at(25e3);
  double least_db = 1e9, most_db = 0;
  for (double range_m = 2150; range_m <= 2300; range_m += 1) {
    const double loss = loss_db(link_over(config, range_m, sea.end_m, sea.end_m, modem), modem);
    least_db = std::min(least_db, loss);
    most_db = std::max(most_db, loss);
  }
  EXPECT_LT(most_db - least_db, 3) << least_db;
}

// The FRONT network off Montauk Point over 5 km (Codiga et al. 2005): in the mixed water of winter sound
// meets the surface and wind ends the link; below the warm layer of spring it does not.
TEST(FrontShelf, LosesByTheWindInWinterAndNotInSpring) {
  const auto snr_db = [](const std::string& name, double wind_mps) {
    const ScenarioConfig config = trial(name, {fmt::format("environment.wind_mps={}", wind_mps)});
    const LinkSurveyEnd end = link_end(config, "0,0,36");
    return trial_link(config, 5000, 36).reception.budget.snr.value - end.modem.modem.receiver_loss.value;
  };
  constexpr double kWithinDb = 4;
  for (const auto& [wind_mps, winter_db, spring_db] :
       {std::array{3.0, 24.0, 29.0}, {5.0, 18.0, 27.0}, {7.0, 7.0, 26.0}, {9.0, -1.0, 24.0}}) {
    EXPECT_NEAR(snr_db("front_winter", wind_mps), winter_db, kWithinDb) << wind_mps;
    EXPECT_NEAR(snr_db("front_spring", wind_mps), spring_db, kWithinDb) << wind_mps;
  }
  // Packets of robust keying end with the wind some 2 m/s later than those that were counted there.
  const auto delivery = [](const std::string& name, double wind_mps) {
    const ScenarioConfig config = trial(name, {fmt::format("environment.wind_mps={}", wind_mps)});
    return trial_link(config, 5000, 36).forecast.delivery_probability;
  };
  EXPECT_GT(delivery("front_winter", 7), 0.9);
  EXPECT_LT(delivery("front_winter", 12), 0.5);
  EXPECT_GT(delivery("front_spring", 12), 0.9);
}

// Medians of a peer's ray model with waves and hills (Morozs et al. 2020, IEEE Access 8, with the data of
// their channel model): 70 m, nodes within 7 m of the bottom, 24 kHz, wind 10 m/s without bubbles, a fluid of
// 1600 m/s and the water's density below hills of up to 2 m on 200 m. July's profile is theirs; January's is
// mixed from top to bottom.
TEST(NorthSea, LosesAsAPeersRaysThroughWavesAndHills) {
  struct Month {
    const char* name;
    const char* water;
    std::array<double, 5> medians_db;  // at 1 to 5 km
  };
  const std::array<Month, 2> months{{
      {"January", "[[0.0, 5.5, 35.0], [70.0, 5.5, 35.0]]", {57.3, 66.1, 75.8, 83.2, 90.3}},
      {"July",
       "[[0.0, 14.189, 35.0], [10.0, 13.75, 35.0], [20.0, 12.666, 35.0], [30.0, 10.7, 35.0], "
       "[50.0, 7.889, 35.0], [70.0, 6.799, 35.0]]",
       {52.4, 66.1, 74.7, 81.9, 89.3}},
  }};
  const VehicleModem modem = modem_at(24e3);
  for (const Month& month : months) {
    const PlainSea sea{
        month.name, 70, 66.7, month.water, "MediumSand", 10, "absorption_model = \"thorp-jensen\""};
    ScenarioConfig config = stilled(sea.scenario());
    channel_server::PropagationConfig& propagation = config.channel_server.propagation;
    propagation.sediment = "custom";
    propagation.bottom_density_ratio = 1;
    propagation.bottom_sound_speed_mps = 1600;
    propagation.bottom_attenuation_db = 0;
    propagation.fading.bottom_roughness_m = 0.3;
    propagation.fading.bottom_slope = 0.03;
    propagation.rays.surface = acoustics::SurfaceModel::kFlat;
    for (std::size_t km = 1; km <= 5; ++km) {
      std::vector<double> losses;
      for (const double depth_m : {63.4, 64.4, 65.3, 66.0, 66.7}) {
        losses.push_back(
            loss_db(link_over(config, 1000.0 * static_cast<double>(km), sea.end_m, depth_m, modem), modem));
      }
      std::sort(losses.begin(), losses.end());
      EXPECT_NEAR(losses[losses.size() / 2], month.medians_db[km - 1], km < 4 ? 4 : 6) << month.name << km;
    }
  }
}

// Prudhoe Bay, 7.5 m under fast ice with keels: the rate fell from 5000 to 80 bit/s between 1.5 and 5.6 km.
// Over 750 depths one profile may focus or lose a link: the means of an ensemble.
TEST(UnderIce, ShallowWaterCarriesTheSlowRateFurther) {
  const auto delivery = [](const std::string& profile, double range_m) {
    const ScenarioConfig config = trial("prudhoe", {"modem.profile=" + profile, "modem.source_level_db=185",
                                                    "modem.center_frequency_hz=10000"});
    return ensemble_mean(config, [&](const ScenarioConfig& member) {
      return trial_link(member, range_m, 4).forecast.delivery_probability;
    });
  };
  EXPECT_GT(delivery("micromodem-psk-5", 1500), 0.5);
  for (const double range_m : {5700.0, 7000.0}) EXPECT_LT(delivery("micromodem-psk-5", range_m), 0.9);
  EXPECT_GT(delivery("micromodem-fsk", 5600), 0.5);
  EXPECT_LT(delivery("micromodem-fsk", 10'000), 0.5);
}

// Off Thule, 300 m under fast ice at 3.5 kHz: reliable to 20 km, moderate to 35 km. The oracle's ratios of
// signal to noise, less the receiver's loss, are for a noise of 50 dB; the table of places has 45 dB at 3.5
// kHz, within what places differ by.
TEST(UnderIce, DeepWaterCarriesTensOfKilometres) {
  const ScenarioConfig config = trial("thule", {"environment.noise_offset_db=5"});
  const auto link = [&](double range_m) { return trial_link(config, range_m, 60); };
  for (const double range_m : {1000.0, 5000.0, 10'000.0, 15'000.0, 20'000.0})
    EXPECT_GT(link(range_m).forecast.delivery_probability, 0.9) << range_m;
  EXPECT_LT(link(45'000).forecast.delivery_probability, 0.5);
  const double loss_db = link_end(config, "0,0,60").modem.modem.receiver_loss.value;
  for (const auto& [km, snr_db] : {std::pair(20, 16), {25, 11}, {30, 7}, {35, 3}, {45, -6}})
    EXPECT_NEAR(link(1000.0 * km).reception.budget.snr.value - loss_db, snr_db, 4) << km;
}

// Two moored ends 500 m apart in a gale: half a metre below the surface bubbles, and waves that leave them in
// the air, take what ends at 20 m keep.
TEST(Gale, TakesThePacketsOfEndsJustBelowTheSurface) {
  const auto link = [](double end_m) {
    const PlainSea sea{"gale",
                       200,
                       end_m,
                       "[[0.0, 10.0, 35.0], [200.0, 10.0, 35.0]]",
                       "SandyMud",
                       14,
                       "",
                       fmt::format("[[vehicle]]\nname = \"b\"\nid = 2\nmodel = \"fixed\"\n"
                                   "start_ned_m = [-5000.0, 0.0, {}]\n",
                                   end_m)};
    const ScenarioConfig config = stilled(sea.scenario());
    return survey_link(config, link_end(config, "a"), link_end(config, "b"));
  };
  const LinkSurvey shallow = link(0.5), deep = link(20);
  EXPECT_GT(shallow.reception.budget.transmission_loss.value,
            deep.reception.budget.transmission_loss.value + 10);
  EXPECT_LT(shallow.forecast.delivery_probability, 0.5);
  EXPECT_GT(deep.forecast.delivery_probability, 0.9);
}

}  // namespace
}  // namespace halocline::clients
