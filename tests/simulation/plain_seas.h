// SPDX-License-Identifier: BSD-3-Clause
// Plain seas: level water over one sediment, with a profile and a wind; and links in them.
#pragma once

#include <array>
#include <cmath>
#include <string>

#include "bus/config/config.h"
#include "channel_server/modems/modem_config.h"
#include "simulation/composition.h"
#include "simulation/link_survey.h"

namespace halocline::testing {

// A sea of one depth. `water` has rows of depth, temperature and salinity; without them the speed is
// 1500 m/s everywhere. `keys` may hold more of [environment], `tail` more of the vehicle "a" and what follows
// it.
struct PlainSea {
  std::string name;
  double depth_m = 0, end_m = 0;  // of the water; of both ends of a link
  std::string water;
  std::string sediment;
  double wind_mps = 5;
  std::string keys = "", tail = "";

  std::string profile() const {
    return water.empty() ? "profile = \"isovelocity\"" : "profile = \"water-table\"\nwater_rows = " + water;
  }
  // Its scenario, with the defaults of all other keys.
  clients::ScenarioConfig scenario() const {
    const std::string text =
        "[scenario]\nname = \"" + name +
        "\"\nseed = 1\nduration_s = 60\n"
        "[terrain]\nkind = \"flat\"\nsize_north_m = 12000\nsize_east_m = 2000\n[terrain.flat]\ndepth_m = " +
        std::to_string(depth_m) + "\n[environment]\n" + profile() +
        "\nwind_mps = " + std::to_string(wind_mps) + "\n" + keys + "\n[propagation]\nsediment = \"" +
        sediment + "\"\n[[vehicle]]\nname = \"a\"\nid = 1\nmodel = \"fixed\"\nstart_ned_m = [-5500.0, 0.0, " +
        std::to_string(end_m) + "]\n" + tail;
    auto file = bus::ConfigFile::parse(text, name + ".toml");
    return clients::load_scenario(file, clients::ScenarioUse::kWater);
  }
};

// The seas in which modems are compared.
inline const std::array<PlainSea, 6>& plain_seas() {
  static const std::array<PlainSea, 6> seas{{
      {"winter", 100, 60, "[[0.0, 8.0, 35.0], [100.0, 8.0, 35.0]]", "MediumSand"},
      {"summer", 100, 60,
       "[[0.0, 22.0, 35.0], [15.0, 22.0, 35.0], [30.0, 15.0, 35.0], [50.0, 13.0, 35.0], [100.0, 13.0, 35.0]]",
       "MediumSand"},
      {"tropic", 15, 7.5, "[[0.0, 29.5, 32.0], [15.0, 29.0, 32.0]]", "SandySilt"},
      {"singapore", 15, 7.5, "[[0.0, 29.0, 32.0], [15.0, 29.0, 32.0]]", "MuddySand"},
      {"harbour", 12, 6, "[[0.0, 12.0, 30.0], [12.0, 12.0, 30.0]]", "SandyMud"},
      {"deep", 3000, 60, "[[0.0, 13.0, 35.0], [300.0, 10.0, 35.0], [1000.0, 5.0, 35.0], [3000.0, 2.0, 35.0]]",
       "SandySilt"},
  }};
  return seas;
}

// The link from -5500 m north over a range, between two depths, of a modem's profile.
inline clients::LinkSurvey link_over(const clients::ScenarioConfig& config, double range_m, double from_m,
                                     double to_m, const channel_server::VehicleModem& modem) {
  const auto end = [&](double north_m, double depth_m) {
    clients::LinkSurveyEnd at = link_end(config, std::to_string(north_m) + ",0," + std::to_string(depth_m));
    at.modem = modem;
    return at;
  };
  return survey_link(config, end(-5500, from_m), end(range_m - 5500, to_m));
}

}  // namespace halocline::testing
