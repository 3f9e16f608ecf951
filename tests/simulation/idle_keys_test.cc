// SPDX-License-Identifier: BSD-3-Clause
// Keys that have no effect: each choice, and a key that lacks it.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/simulation/scenario_checks_fixture.h"

namespace halocline::clients {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using IdleKeys = ScenarioChecks;

// A key that lacks the choice under which it counts, and the words for that choice.
struct IdleKey {
  std::string toml, key, choice;
};

TEST_F(IdleKeys, KeysThatLackTheirChoiceAreWarnedOf) {
  const std::string vehicle = vehicle_with("");
  const std::vector<IdleKey> idle{
      {"[environment]\nprofile_file = \"cast.csv\"\n", "environment.profile_file", "profile = \"file\""},
      {"[environment]\nprofile = \"munk\"\nisovelocity_mps = 1490\n", "environment.isovelocity_mps",
       "profile = \"isovelocity\""},
      {"[environment]\nwater_rows = [[0, 10, 35]]\n", "environment.water_rows", "profile = \"water-table\""},
      {"[environment]\nassumed_salinity_psu = 30\n", "environment.assumed_salinity_psu",
       "profile = \"munk\" or \"isovelocity\" or \"file\""},
      {"[environment]\nimpulse_level_db = 3\n", "environment.impulse_level_db", "impulse_exponent above 0"},
      {"[water_load]\nparticle_um = 3\n", "water_load.particle_um", "particles_kg_m3 above 0"},
      {"[terrain.raster]\npath = \"gone.tif\"\n", "terrain.raster", "kind = \"raster\""},
      {"[terrain.slope]\nslope = 0.1\n", "terrain.slope", "kind = \"slope\""},
      {"[terrain]\nframe = \"enu\"\n", "terrain.frame", "kind = \"raster\", or a nested raster"},
      {"[terrain.relief]\nhurst = 0.5\n", "terrain.relief.hurst", "rms_m above 0"},
      {"[ocean]\ncarries_sound = false\n", "ocean.carries_sound", "file = \"FILE\""},
      {"[ocean]\nmoves_vehicles = false\n", "ocean.moves_vehicles", "file = \"FILE\""},
      {"[propagation]\nmodel = \"straight\"\nsediment = \"Clay\"\n", "propagation.sediment",
       "model = \"rays\""},
      {"[propagation]\nbottom_density_ratio = 2\nsediment = \"MediumSand\"\n",
       "propagation.bottom_density_ratio", "sediment = \"custom\""},
      {"[propagation]\nfading = \"none\"\nbottom_roughness_m = 0.1\n", "propagation.bottom_roughness_m",
       "fading = \"sea\""},
      {"[propagation]\nfading = \"sea\"\nlarge_scale_fading_db = 0\nlarge_scale_fading_s = 9\n",
       "propagation.large_scale_fading_s", "large_scale_fading_db above 0"},
      {"[propagation]\nfading = \"sea\"\nslow_fading_db = 0\nslow_fading_s = 9\n",
       "propagation.slow_fading_s", "slow_fading_db above 0"},
      {"[environment]\nnoise_spread_db = 0\nnoise_spread_s = 9\n", "environment.noise_spread_s",
       "noise_spread_db above 0"},
      {"[propagation]\nreplay_level = \"file\"\n", "propagation.replay_level",
       "replay = \"FILE\" or a replay_pair"},
      {"[modem]\ncarrier_threshold_db = 3\n", "modem.carrier_threshold_db", "events = true"},
      {"[vehicle_sim.waves]\nheight_m = 2\n", "vehicle_sim.waves.height_m",
       "sea = \"regular\" or \"pierson-moskowitz\" or \"jonswap\""},
      {"[vehicle_sim.current]\ntide_period_s = 9\n", "vehicle_sim.current.tide_period_s",
       "tide_amplitude_mps above 0"},
      {"[sensors.dvl]\nrate_hz = 0\nrange_m = 50\n", "sensors.dvl.range_m", "rate_hz above 0"},
      {"[network]\ninterval_s = 9\n", "network.interval_s", "a mac"},
      {"[network]\nmac = \"csma\"\nslot_s = 9\n", "network.slot_s", "mac = \"slotted-aloha\" or \"tdma\""},
  };
  for (const IdleKey& one : idle) {
    const Findings found = findings_in(one.toml + vehicle);
    EXPECT_THAT(found.errors, IsEmpty()) << one.toml;
    EXPECT_THAT(found.warnings, ElementsAre(AllOf(HasSubstr("sea.toml:"), HasSubstr(": " + one.key + " is "),
                                                  HasSubstr("counts only with " + one.choice))))
        << one.toml;
  }
}

TEST_F(IdleKeys, KeysOfAVehicleThatLackTheirChoiceAreWarnedOf) {
  const std::vector<IdleKey> idle{
      {"has_modem = false\n[vehicle.modem]\nsource_level_db = 180\n", "modem", "has_modem = true"},
      {"has_modem = false\n[vehicle.traffic]\nperiod_s = 9\n", "traffic", "has_modem = true"},
      {"has_modem = false\n[vehicle.localiser]\nstart_sigma_m = 9\n", "localiser", "has_modem = true"},
      {"[[vehicle.mission.behaviour]]\nkind = \"survey\"\naltitude_m = 9\nmax_depth_m = 99\ndepth_m = 20\n",
       "mission.behaviour[0].depth_m", "altitude_m = 0"},
      {"[vehicle.clock]\nset_by_gps = false\ngps_residual_s = 0.1\n", "clock.gps_residual_s",
       "set_by_gps = true"},
      {"[vehicle.noise]\nvaries_with = \"nothing\"\nreference_rpm = 900\n", "noise.reference_rpm",
       "varies_with = \"propeller\""},
      {"[vehicle.traffic]\npayload_bytes = 9\n", "traffic.payload_bytes", "period_s above 0"},
      {"[vehicle.mission]\nwaypoints = [[100, 0, 20]]\n[vehicle.mission.navigator]\nlog_drift_mps = 0.1\n",
       "mission.navigator", "navigate_by = \"sensors\""},
      {"[vehicle.mission]\nwaypoints = [[100, 0, 20]]\nat_end = \"stop\"\nhold_radius_m = 30\n",
       "mission.hold_radius_m", "at_end = \"hold\""},
      {"[vehicle.mission]\nwaypoints = [[100, 0, 20]]\n[vehicle.mission.glide]\nvolume_m3 = 0.1\n",
       "mission.glide", "steering = \"buoyancy\""},
      {"[[vehicle.mission.behaviour]]\nkind = \"loiter\"\ndepth_m = 20\nlength_m = 30\n",
       "mission.behaviour[0].length_m", "kind = \"survey\""},
      {"[[vehicle.mission.behaviour]]\nkind = \"survey\"\ndepth_m = 20\nradius_m = 30\n",
       "mission.behaviour[0].radius_m", "kind = \"loiter\" or \"follow\" or \"seek_link\""},
  };
  for (const IdleKey& one : idle) {
    EXPECT_THAT(findings_in(vehicle_with(one.toml)).warnings,
                ElementsAre(AllOf(HasSubstr(": vehicle[0]." + one.key + " is "),
                                  HasSubstr("counts only with " + one.choice))))
        << one.toml;
  }
  EXPECT_THAT(findings_in(vehicle_with("speed_mps = 1\n", "fixed")).warnings,
              ElementsAre(HasSubstr("vehicle[0].speed_mps is 1; it has no effect")));
}

// A key of [sensors] holds for a vehicle that has the instrument in its own table.
TEST_F(IdleKeys, CommonKeysOfAnInstrumentCountWhereOneVehicleHasIt) {
  EXPECT_THAT(
      findings_in("[sensors.dvl]\nrange_m = 50\n" + vehicle_with("[vehicle.sensors.dvl]\nrate_hz = 1\n"))
          .warnings,
      IsEmpty());
}

// A key of [modem] holds for a vehicle that reports events by its own table.
TEST_F(IdleKeys, TheCommonCarrierThresholdCountsWhereOneVehicleHasEvents) {
  const std::string common = "[modem]\ncarrier_threshold_db = 3\n";
  EXPECT_THAT(findings_in(common + vehicle_with("[vehicle.modem]\nevents = true\n")).warnings, IsEmpty());
  EXPECT_THAT(findings_in(common + vehicle_with("[vehicle.modem]\nevents = false\n")).warnings,
              ElementsAre(HasSubstr("modem.carrier_threshold_db is 3")));
}

TEST_F(IdleKeys, TheGridOfAWholeRasterIsWarnedOf) {
  std::string text = level_raster();
  text.insert(text.find("[terrain.raster]"), "spacing_m = 7\n");
  EXPECT_THAT(findings_in(text + vehicle_with("")).warnings,
              ElementsAre(AllOf(HasSubstr("terrain.spacing_m is 7"), HasSubstr("whole_file = false"))));
}

TEST_F(IdleKeys, AChangeOfTheWaterWithoutAProfileIsToldThatItNeedsOne) {
  EXPECT_THAT(
      findings_in("[[environment_change]]\nat_s = 5\nwater_rows = [[0, 10, 35]]\n" + vehicle_with("")).errors,
      ElementsAre(AllOf(HasSubstr("environment_change[0].water_rows is "), HasSubstr("it needs a profile"))));
}

}  // namespace
}  // namespace halocline::clients
