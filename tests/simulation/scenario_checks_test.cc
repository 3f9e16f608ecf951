// SPDX-License-Identifier: BSD-3-Clause
// Each sanity check: a scenario that fails it, and one beside it that does not.
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/atomic_file.h"
#include "tests/simulation/scenario_checks_fixture.h"

namespace halocline::clients {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST_F(ScenarioChecks, AVehicleStartsInTheWater) {
  EXPECT_THAT(errors_with("start_ned_m = [0.0, 0.0, 100.0]\n"), IsEmpty());
  EXPECT_THAT(
      errors_with("start_ned_m = [0.0, 0.0, 101.5]\n"),
      ElementsAre(AllOf(
          HasSubstr("sea.toml:5: vehicle[0].start_ned_m is ["), HasSubstr("101.5"),
          HasSubstr("vehicle auv: that is below the seabed; allowed there is a z, positive down, of 0 m "
                    "(the sea surface) to 100 m (the seabed)"))));
  EXPECT_THAT(errors_with("start_ned_m = [0.0, 0.0, -20.0]\n"),
              ElementsAre(HasSubstr("above the sea surface")));
  EXPECT_THAT(errors_with("start_ned_m = [2000.1, 0.0, 20.0]\n"), IsEmpty()) << "a level bottom has no end";
  const std::string raster = level_raster();
  EXPECT_THAT(findings_in(raster + vehicle_with("start_ned_m = [500.0, 0.0, 20.0]\n")).errors, IsEmpty());
  EXPECT_THAT(
      findings_in(raster + vehicle_with("start_ned_m = [500.1, 0.0, 20.0]\n")).errors,
      ElementsAre(HasSubstr("the terrain is not known there; allowed is a place on it, north -500 to 500 m, "
                            "east -500 to 500 m")));
}

TEST_F(ScenarioChecks, AFixedVehicleIsCheckedAndAnExternalOneIsNot) {
  EXPECT_THAT(errors_with("start_ned_m = [0.0, 0.0, 101.5]\n", "fixed"),
              ElementsAre(HasSubstr("below the seabed")));
  EXPECT_THAT(errors_with("start_ned_m = [0.0, 0.0, 101.5]\n", "external"), IsEmpty());
}

TEST_F(ScenarioChecks, AStartOnLandIsRefused) {
  EXPECT_THAT(findings_in("[terrain]\nkind = \"slope\"\n[terrain.slope]\ndepth_m = -3\nslope = 0.0\n" +
                          vehicle_with(""))
                  .errors,
              ElementsAre(HasSubstr("there is land, 3 m above the sea")));
}

TEST_F(ScenarioChecks, AWaypointLiesInTheWater) {
  const auto errors = [&](const std::string& point) {
    return errors_with("[vehicle.mission]\nwaypoints = [[10.0, 0.0, 20.0], " + point + "]\n");
  };
  EXPECT_THAT(errors("[50.0, 0.0, 99.0]"), IsEmpty());
  EXPECT_THAT(errors("[50.0, 0.0, 120.0]"),
              ElementsAre(AllOf(HasSubstr("sea.toml:7: vehicle[0].mission.waypoints[1] is ["),
                                HasSubstr("below the seabed"))));
  EXPECT_THAT(errors("[50.0, 0.0, -20.0]"), ElementsAre(HasSubstr("above the sea surface")));
  EXPECT_THAT(errors("[50.0, 0.0, -0.5]"), IsEmpty());  // to come up
  const std::string outside = vehicle_with("[vehicle.mission]\nwaypoints = [[3000.0, 0.0, 20.0]]\n");
  EXPECT_THAT(findings_in(outside).errors, IsEmpty());
  EXPECT_THAT(findings_in(outside).warnings, IsEmpty()) << "a level bottom has no end";
  const auto beyond = findings_in(level_raster() + outside);
  EXPECT_THAT(beyond.errors, IsEmpty());
  EXPECT_THAT(beyond.warnings, ElementsAre(HasSubstr("the terrain is not known there")));
}

TEST_F(ScenarioChecks, ALevelBottomAsksForNoSpacing) {
  const std::string vehicle = vehicle_with(""), size = "[terrain]\nsize_north_m = 4010.0\n";
  EXPECT_THAT(findings_in(vehicle + size).errors, IsEmpty());
  EXPECT_THAT(findings_in(vehicle + size + "kind = \"slope\"\n").errors,
              ElementsAre(HasSubstr("allowed is a spacing that divides")));
}

// 53 bytes at 200 bit/s last 2.12 s and their preamble; the farthest two are 600 m apart.
TEST_F(ScenarioChecks, ANetworksTimesHoldItsPacketsAndItsDistances) {
  const auto warnings = [&](const std::string& network) {
    std::string text = "[modem]\nbit_rate_bps = 200.0\n[network]\n" + network;
    for (const int i : {1, 2, 3})
      text += "[[vehicle]]\nname = \"n" + std::to_string(i) + "\"\nid = " + std::to_string(i) +
              "\nmodel = \"fixed\"\nstart_ned_m = [" + std::to_string(300 * i) +
              ".0, 0.0, 30.0]\n[vehicle.network]\ndestination = \"" + (i == 3 ? "n1" : "n3") + "\"\n";
    return findings_in(text).warnings;
  };
  const std::string tdma = "mac = \"tdma\"\n";
  EXPECT_THAT(warnings(tdma + "slot_s = 0.1\n"),
              ElementsAre(AllOf(HasSubstr("network.slot_s is 0.1"), HasSubstr("a packet of data"))));
  EXPECT_THAT(warnings(tdma + "slot_s = 10.0\n"), IsEmpty());
  EXPECT_THAT(warnings("mac = \"slotted-aloha\"\nslot_s = 1.0\n"), ElementsAre(HasSubstr("slot_s")));
  EXPECT_THAT(warnings("mac = \"t-lohi\"\ncontention_s = 0.5\n"),
              ElementsAre(HasSubstr("a tone and twice the greatest travel time")));
  EXPECT_THAT(warnings("mac = \"t-lohi\"\ncontention_s = 2.0\n"), IsEmpty());
  EXPECT_THAT(warnings("mac = \"maca\"\nhandshake_s = 0.5\nexchange_s = 0.5\n"),
              ElementsAre(HasSubstr("handshake_s"), HasSubstr("exchange_s")));
  EXPECT_THAT(warnings("mac = \"aloha-ca\"\npacket_s = 0.5\n"), ElementsAre(HasSubstr("packet_s")));
}

// Two vehicles 100 m from each other, and a ship.
std::string network_beside_a_ship(const std::string& network, const std::string& has_modem) {
  std::string text = "[network]\n" + network;
  for (const auto& [name, north_m] : {std::pair("a", 0), std::pair("b", 100), std::pair("ship", 1900)})
    text += std::string("[[vehicle]]\nname = \"") + name + "\"\nid = " + std::to_string(1 + north_m) +
            "\nmodel = \"fixed\"\nstart_ned_m = [" + std::to_string(north_m) + ".0, 0.0, 30.0]\n" +
            (name == std::string("ship") ? "has_modem = " + has_modem + "\n" : "") +
            (name == std::string("a") ? "[vehicle.network]\ndestination = \"b\"\n" : "");
  return text;
}

TEST_F(ScenarioChecks, ANetworksDistancesAreThoseOfVehiclesWithAModem) {
  const std::string network = "mac = \"t-lohi\"\ncontention_s = 1.5\n";
  EXPECT_THAT(findings_in(network_beside_a_ship(network, "true")).warnings,
              ElementsAre(HasSubstr("a tone and twice the greatest travel time")));
  EXPECT_THAT(findings_in(network_beside_a_ship(network, "false")).warnings, IsEmpty());
}

TEST_F(ScenarioChecks, ANetworksPacketsFitTheModemsThatSendThem) {
  const auto errors = [&](const std::string& bytes) {
    return findings_in(network_beside_a_ship("mac = \"aloha\"\ndata_bytes = " + bytes + "\n", "false"))
        .errors;
  };
  EXPECT_THAT(errors("100"), IsEmpty());
  EXPECT_THAT(errors("5000"), ElementsAre(AllOf(HasSubstr("network.data_bytes is 5000"),
                                                HasSubstr("its packets have 5021 bytes"))));
}

TEST_F(ScenarioChecks, ASurveyLiesAboveTheSeabed) {
  const auto survey = [&](const std::string& keys) {
    return vehicle_with("[vehicle.mission]\n[[vehicle.mission.behaviour]]\nkind = \"survey\"\n" + keys);
  };
  EXPECT_THAT(findings_in(survey("depth_m = 90\n")).errors, IsEmpty());
  EXPECT_THAT(findings_in(survey("depth_m = 110\n")).errors,
              ElementsAre(AllOf(HasSubstr("sea.toml:9: vehicle[0].mission.behaviour[0].depth_m is 110"),
                                HasSubstr("the whole survey lies below the seabed"))));
  EXPECT_THAT(findings_in(survey("depth_m = -5\n")).errors,
              ElementsAre(HasSubstr("the survey lies above the sea")));
  EXPECT_THAT(findings_in(survey("altitude_m = 5\ndepth_m = 110\n")).errors, IsEmpty());
  const std::string slope = "[terrain]\nkind = \"slope\"\n[terrain.slope]\ndepth_m = 50\nslope = 0.05\n";
  const Findings partly = findings_in(slope + survey("depth_m = 50\n"));
  EXPECT_THAT(partly.errors, IsEmpty());
  EXPECT_THAT(partly.warnings, ElementsAre(HasSubstr("% of the survey lies below the seabed")));
  EXPECT_THAT(
      findings_in(vehicle_with(
                      "[vehicle.mission]\n[[vehicle.mission.behaviour]]\nkind = \"loiter\"\ndepth_m = 110\n"))
          .errors,
      ElementsAre(HasSubstr("the whole circle lies below the seabed")));
}

// 20 x 20 posts 100 m apart in local metres.
void write_raster(const std::string& path) {
  std::ofstream out(path);
  out << "ncols 20\nnrows 20\nxllcorner -1000\nyllcorner -1000\ncellsize 100\n";
  for (int row = 0; row < 20; ++row) {
    for (int column = 0; column < 20; ++column) out << "-80 ";
    out << "\n";
  }
}

TEST_F(ScenarioChecks, ARasterSmallerThanTheGridIsWarnedOf) {
  write_raster(folder_ + "/terrain.asc");
  const auto terrain = [](const char* size) {
    return "[terrain]\nkind = \"raster\"\nspacing_m = 100\nsize_north_m = " + std::string(size) +
           "\nsize_east_m = " + size +
           "\n[terrain.raster]\npath = \"terrain.asc\"\ncoordinate_system = \"local\"\n" + vehicle_with("");
  };
  EXPECT_THAT(findings_in(terrain("1800")).errors, IsEmpty());
  EXPECT_THAT(findings_in(terrain("1800")).warnings, IsEmpty());
  EXPECT_THAT(
      findings_in(terrain("3000")).warnings,
      ElementsAre(AllOf(HasSubstr("sea.toml:7: terrain.raster.path is 'terrain.asc'"),
                        HasSubstr("posts of the grid have no depth: the raster is smaller than the grid"))));
}

TEST_F(ScenarioChecks, MissingFilesAreNamedWithTheReason) {
  const auto errors = [&](const std::string& text) { return findings_in(text).errors; };
  const std::string gone = "there is no such file";
  EXPECT_THAT(
      errors("[terrain]\nkind = \"raster\"\n[terrain.raster]\npath = \"gone.tif\"\n"),
      ElementsAre(AllOf(HasSubstr("sea.toml:4: terrain.raster.path is 'gone.tif'"), HasSubstr(gone))));
  EXPECT_THAT(
      errors("[environment]\nprofile = \"file\"\nprofile_file = \"gone.csv\"\n"),
      ElementsAre(AllOf(HasSubstr("sea.toml:3: environment.profile_file is 'gone.csv'"), HasSubstr(gone))));
  EXPECT_THAT(errors("[propagation]\nreplay = \"gone.mat\"\n"),
              ElementsAre(AllOf(HasSubstr("sea.toml:2: propagation.replay is 'gone.mat'"), HasSubstr(gone))));
  EXPECT_THAT(errors(vehicle_with("", "gone.toml")),
              ElementsAre(AllOf(HasSubstr("sea.toml:4: vehicle[0].model is 'gone.toml'"), HasSubstr(gone))));
}

TEST_F(ScenarioChecks, FilesThatCannotBeUnderstoodAreNamedWithTheReason) {
  replace_file(folder_ + "/bad.csv", "nothing\n");
  EXPECT_THAT(findings_in("[environment]\nprofile = \"file\"\nprofile_file = \"bad.csv\"\n").errors,
              ElementsAre(HasSubstr("sea.toml:3: environment.profile_file is 'bad.csv'")));
  EXPECT_THAT(findings_in("[terrain]\nkind = \"raster\"\n[terrain.raster]\npath = \"bad.csv\"\n").errors,
              ElementsAre(HasSubstr("sea.toml:4: terrain.raster.path is 'bad.csv'")));
}

TEST_F(ScenarioChecks, HoverIsSteeredByThrustersAndTorpedoByFins) {
  const auto errors = [&](const std::string& model, const std::string& steering) {
    return errors_with("[vehicle.mission]\nwaypoints = [[50.0, 0.0, 20.0]]\n" + steering, model);
  };
  EXPECT_THAT(errors("hover", "steering = \"thrusters\"\n"), IsEmpty());
  EXPECT_THAT(
      errors("hover", ""),
      ElementsAre(
          AllOf(HasSubstr("vehicle[0].mission.steering is fins by default; the model hover has no propeller"),
                HasSubstr("allowed for it is \"thrusters\""))));
  EXPECT_THAT(errors("torpedo", "steering = \"thrusters\"\n"),
              ElementsAre(AllOf(HasSubstr("sea.toml:8"), HasSubstr("allowed for it is \"fins\""))));
}

TEST_F(ScenarioChecks, AGliderIsSteeredByBuoyancyAndASurfaceCraftByTwoThrusters) {
  const auto errors = [&](const std::string& model, const std::string& steering,
                          const std::string& more = "") {
    return errors_with(
        "start_ned_m = [0.0, 0.0, 1.0]\n[vehicle.mission]\nwaypoints = [[50.0, 0.0, 20.0]]\nsteering = \"" +
            steering + "\"\n" + more,
        model);
  };
  EXPECT_THAT(errors("glider", "buoyancy"), IsEmpty());
  EXPECT_THAT(errors("glider", "fins"), ElementsAre(HasSubstr("allowed for it is \"buoyancy\"")));
  EXPECT_THAT(errors("surface-craft", "thrusters", "speed_mps = 1\n"), IsEmpty());
  EXPECT_THAT(errors("surface-craft", "buoyancy"), ElementsAre(HasSubstr("allowed for it is \"thrusters\"")));
  EXPECT_THAT(errors("drifter", "buoyancy"), ElementsAre(HasSubstr("it cannot be piloted")));
}

TEST_F(ScenarioChecks, ALanderWaitsAndDoesNothingElse) {
  const auto errors = [&](const std::string& kind) {
    return errors_with(
        "[vehicle.mission]\nsteering = \"buoyancy\"\nat_end = \"surface\"\n"
        "[[vehicle.mission.behaviour]]\nkind = \"" +
            kind + "\"\nduration_s = 100\n",
        "lander");
  };
  EXPECT_THAT(errors("wait"), IsEmpty());
  EXPECT_THAT(errors("heading"), ElementsAre(HasSubstr("allowed for it is \"wait\"")));
}

TEST_F(ScenarioChecks, ASpeedThatTheVehicleDoesNotHoldIsRefused) {
  const auto errors = [&](const std::string& model, const std::string& keys) {
    return errors_with("[vehicle.mission]\n" + keys + "waypoints = [[50.0, 0.0, 20.0]]\n", model);
  };
  const std::string thrusters = "steering = \"thrusters\"\n";
  EXPECT_THAT(errors("hover", thrusters), IsEmpty());  // 1.5 m/s
  EXPECT_THAT(errors("hover", thrusters + "speed_mps = 1.8\n"), IsEmpty());
  EXPECT_THAT(errors("hover", thrusters + "speed_mps = 2.5\n"),
              ElementsAre(AllOf(HasSubstr("sea.toml:8: vehicle[0].mission.speed_mps is 2.5"),
                                HasSubstr("allowed is at most 1.9"))));
  EXPECT_THAT(errors("torpedo", "speed_mps = 2.5\n"), IsEmpty());
  EXPECT_THAT(errors("torpedo", "speed_mps = 3.5\n"), ElementsAre(HasSubstr("allowed is at most 2.6")));
  // A hull that is turned by its own flow, as with the gains of before.
  EXPECT_THAT(
      errors_with("[vehicle.mission]\nsteering = \"thrusters\"\nwaypoints = [[50.0, 0.0, 20.0]]\n"
                  "[vehicle.mission.hover_gains]\npitch_p_nm = 20\npitch_d_nm_s = 30\n",
                  "hover"),
      ElementsAre(AllOf(HasSubstr("mission.speed_mps is 1.5 by default"), HasSubstr("holds at its depth"))));
}

TEST_F(ScenarioChecks, TheSpeedOfEachBehaviourIsChecked) {
  EXPECT_THAT(
      errors_with("[vehicle.mission]\n[[vehicle.mission.behaviour]]\nkind = \"heading\"\nspeed_mps = 4\n"),
      ElementsAre(HasSubstr("sea.toml:9: vehicle[0].mission.behaviour[0].speed_mps is 4")));
}

TEST_F(ScenarioChecks, TrafficGoesToAnotherVehicle) {
  const auto errors = [&](const std::string& to) {
    return errors_with("[vehicle.traffic]\nperiod_s = 100\ndestination = \"" + to + "\"\n");
  };
  EXPECT_THAT(errors("all"), IsEmpty());
  EXPECT_THAT(errors("auv"),
              ElementsAre(HasSubstr("sea.toml:8: vehicle[0].traffic.destination is 'auv'; a vehicle does not "
                                    "send to itself")));
  EXPECT_THAT(errors("aux"), ElementsAre(HasSubstr("allowed is the name of a vehicle of the scenario")));
}

TEST_F(ScenarioChecks, APayloadFitsTheModem) {
  const auto errors = [&](const std::string& bytes) {
    return errors_with("[vehicle.traffic]\nperiod_s = 1000\npayload_bytes = " + bytes +
                       "\n[vehicle.modem]\nmax_payload_bytes = 64\n");
  };
  EXPECT_THAT(errors("64"), IsEmpty());
  EXPECT_THAT(errors("65"), ElementsAre(AllOf(HasSubstr("sea.toml:8: vehicle[0].traffic.payload_bytes is 65"),
                                              HasSubstr("at most 64"))));
  EXPECT_THAT(
      errors_with("[vehicle.mission.broadcast]\nperiod_s = 100\n[vehicle.modem]\nmax_payload_bytes = 16\n"),
      ElementsAre(AllOf(HasSubstr("mission.broadcast.period_s is 100"), HasSubstr("17 bytes"))));
}

// 32 bytes at 80 bit/s are 3.2 s.
TEST_F(ScenarioChecks, AShorterPeriodThanAPacketIsWarnedOf) {
  EXPECT_THAT(findings_in(vehicle_with("[vehicle.traffic]\nperiod_s = 3.3\n")).warnings, IsEmpty());
  EXPECT_THAT(findings_in(vehicle_with("[vehicle.traffic]\nperiod_s = 3\n")).warnings,
              ElementsAre(AllOf(HasSubstr("sea.toml:7: vehicle[0].traffic.period_s is 3"),
                                HasSubstr("lasts 3.2 s"))));
}

TEST_F(ScenarioChecks, RelayedPacketsNeedRelaysThatCarryThem) {
  const auto sea = [&](const std::string& second) {
    return findings_in(vehicle_with("[vehicle.traffic]\nperiod_s = 100\nhops = 3\n") +
                       "[[vehicle]]\nname = \"b\"\nid = 2\nstart_ned_m = [50.0, 0.0, 20.0]\n" + second);
  };
  EXPECT_THAT(sea("[vehicle.traffic]\nrelay = true\n").warnings, IsEmpty());
  EXPECT_THAT(sea("").warnings, ElementsAre(AllOf(HasSubstr("sea.toml:8: vehicle[0].traffic.hops is 3"),
                                                  HasSubstr("no vehicle has relay = true"))));
  EXPECT_THAT(sea("[vehicle.traffic]\nrelay = true\n[vehicle.modem]\nmax_payload_bytes = 45\n").errors,
              ElementsAre(AllOf(HasSubstr("vehicle[1].traffic.relay is true"), HasSubstr("up to 46 bytes"))));
}

TEST_F(ScenarioChecks, NamesAreThoseOfVehicles) {
  EXPECT_THAT(
      errors_with(
          "[vehicle.localiser]\nbeacons = \"nobody\"\n[vehicle.mission.navigator]\nusbl_beacons = \"none\"\n"
          "[[fault]]\nvehicle = \"ghost\"\nkind = \"leak\"\n[[tether]]\nvehicle = \"wraith\"\n"),
      ElementsAre(HasSubstr("sea.toml:11: fault[0].vehicle is 'ghost'"),
                  HasSubstr("sea.toml:14: tether[0].vehicle is 'wraith'"),
                  HasSubstr("sea.toml:9: vehicle[0].mission.navigator.usbl_beacons is 'none'"),
                  HasSubstr("sea.toml:7: vehicle[0].localiser.beacons is 'nobody'")));
}

TEST_F(ScenarioChecks, MoreVehiclesThanAreTrackedAreRefused) {
  std::string text;
  for (int i = 1; i <= 16385; ++i)
    text += "[[vehicle]]\nname = \"v" + std::to_string(i) + "\"\nid = " + std::to_string(i) +
            "\nmodel = \"external\"\n";
  EXPECT_THAT(findings_in(text).errors, ElementsAre(AllOf(HasSubstr("vehicle[16384].name is 'v16385'"),
                                                          HasSubstr("follows 16384 vehicles"))));
}

// A log of such a mission can be replayed, and its links computed.
TEST_F(ScenarioChecks, MissionsAreNotCheckedWhereTheWaterAloneIsUsed) {
  replace_file(folder_ + "/sea.toml",
               vehicle_with("[vehicle.mission]\nspeed_mps = 9\nwaypoints = [[0.0, 0.0, 30.0]]\n"));
  EXPECT_THROW(load_scenario(folder_ + "/sea.toml", {}), bus::ConfigErrors);
  EXPECT_NO_THROW(load_scenario(folder_ + "/sea.toml", {}, ScenarioUse::kWater));
}

TEST_F(ScenarioChecks, AllThatMakesNoSenseIsFoundAtOnce) {
  const auto errors = errors_with(
      "start_ned_m = [0.0, 0.0, 200.0]\n[vehicle.mission]\nspeed_mps = 9\nwaypoints = [[0.0, 0.0, 300.0]]\n"
      "[vehicle.traffic]\nperiod_s = 1000\npayload_bytes = 5000\n");
  EXPECT_EQ(errors.size(), 4u) << ::testing::PrintToString(errors);
}

TEST_F(ScenarioChecks, ModemsThatNeverReceiveEachOtherAreWarnedOf) {
  const auto two_with = [](const std::string& first, const std::string& second) {
    const std::string other = "[[vehicle]]\nname = \"b\"\nid = 2\nstart_ned_m = [9.0, 0.0, 20.0]\n";
    return vehicle_with(first) + other + second;
  };
  const auto modem = [](const std::string& lines) { return "[vehicle.modem]\n" + lines; };
  EXPECT_THAT(findings_in(two_with("", "")).warnings, IsEmpty());
  EXPECT_THAT(
      findings_in(two_with(modem("family = \"mine\"\n"), modem("family = \"yours\"\n"))).warnings,
      ElementsAre(HasSubstr("vehicle[1].modem.family is 'yours'; b and auv never receive each other")));
  EXPECT_THAT(findings_in(two_with("", modem("center_frequency_hz = 90000\nbandwidth_hz = 4000\n"))).warnings,
              ElementsAre(HasSubstr("never receive each other")));
  EXPECT_THAT(findings_in(two_with(modem("profile = \"micromodem-psk-1\"\n"),
                                   modem("profile = \"micromodem-psk-5\"\n")))
                  .warnings,
              IsEmpty());
  EXPECT_THAT(findings_in(two_with("", "has_modem = false\n")).warnings, IsEmpty());
}

TEST_F(ScenarioChecks, DegreesInThePlaceOfMetresAreAskedAbout) {
  const std::string origin = "[scenario]\norigin_latitude_deg = 43.2\norigin_longitude_deg = 7.3\n";
  const auto warnings_at = [&](const std::string& start, const std::string& more = "") {
    return findings_in(origin + vehicle_with("start_ned_m = " + start + "\n" + more)).warnings;
  };
  EXPECT_THAT(
      warnings_at("[43.21, 7.32, 20.0]"),
      ElementsAre(AllOf(HasSubstr("sea.toml:8: vehicle[0].start_ned_m"), HasSubstr("are degrees meant?"))));
  EXPECT_THAT(warnings_at("[7.32, 43.21, 20.0]"), ElementsAre(HasSubstr("are degrees meant?")));
  EXPECT_THAT(warnings_at("[0.0, 0.0, 20.0]", "[vehicle.mission]\nwaypoints = [[43.2, 7.4, 20]]\n"),
              ElementsAre(HasSubstr("vehicle[0].mission.waypoints")));
  EXPECT_THAT(warnings_at("[60.0, -30.0, 20.0]"), IsEmpty());
  EXPECT_THAT(findings_in(vehicle_with("start_ned_m = [1.5, 2.5, 20.0]\n")).warnings, IsEmpty());
}

}  // namespace
}  // namespace halocline::clients
