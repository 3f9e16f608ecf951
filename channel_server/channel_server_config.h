// What the channel server reads of a scenario file: [environment], [modem], [vehicle.modem] and
// [channel_server].
//
// The structs are SI; every key's unit and range is in the .cc, where it is visited, and in --example.
#pragma once

#include <string>
#include <vector>

#include "acoustics/environment.h"
#include "bus/config.h"
#include "bus/scenario.h"
#include "channel_server/fleet.h"
#include "channel_server/packet_medium.h"
#include "channel_server/terrain_asker.h"

namespace halocline::channel_server {

// Where temperature and salinity, or speed, come from.
enum class ProfileSource {
  kGlobalMean,
  kGlobalMeanOfSalinity35,
  kHarrisZorzi,
  kMunk,
  kIsovelocity,
  kWaterTable,  // rows of depth, temperature, salinity in the scenario
  kSpeedTable,  // rows of depth and speed in the scenario
  kFile,        // CSV, or netCDF at a position
};

struct ProfileConfig {
  ProfileSource source = ProfileSource::kGlobalMean;
  double isovelocity_mps = 1500;
  std::vector<Vec3> water_rows;                    // depth m, temperature degC, salinity psu
  std::vector<double> speed_depths_m, speeds_mps;  // as many of each
  std::string file, salinity_file;  // relative to the scenario; salinity only where in a file of its own
  bool position_given = false;      // of the column of a gridded file; else the scenario's origin
  double latitude_rad = 0, longitude_rad = 0;
  std::int64_t time_index = 0;  // of a gridded file with several times
  // Where the source knows speeds only; absorption depends on them.
  acoustics::WaterSample assumed{10, 35};
};

struct EnvironmentConfig {
  ProfileConfig profile;
  std::string sound_speed_model = "mackenzie";
  std::string absorption_model = "fisher-simmons";
  acoustics::NoiseSources noise;
  double spreading_exponent = 1.5;
  double ph = 8.0;
};

// How the server works; defaults as in the headers of its parts.
struct ServerRules {
  SimDuration link_period = SimDuration::from_milliseconds(1000);  // between two LINKS of a vehicle
  PositionRule position;
  MediumRule medium;
  AskingRule asking;
  int bottom_points = 9;             // under each link, for its echoes
  double echo_reuse_distance_m = 5;  // how far the ends of a link may move before its echoes are asked anew
};

struct ChannelServerConfig {
  struct OfVehicle {
    std::string name;
    bool has_modem = false;
    VehicleModem modem;
  };
  EnvironmentConfig environment;
  VehicleModem modem;
  std::vector<OfVehicle> vehicles;
  ServerRules rules;
};

void visit(bus::ConfigVisitor& v, ChannelServerConfig& config);

// The water of a scenario whose file lies in `folder`. Throws InvalidArgument when a profile cannot be read or
// is impossible.
acoustics::Environment make_environment(const EnvironmentConfig& config, const bus::Scenario& scenario,
                                        const std::string& folder);

ConfiguredModems make_modems(const ChannelServerConfig& config);

}  // namespace halocline::channel_server
