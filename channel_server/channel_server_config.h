// SPDX-License-Identifier: BSD-3-Clause
// What the channel server reads of a scenario file: [environment], [propagation], [[environment_change]],
// [modem], [vehicle.modem], [vehicle.clock], [vehicle.noise] and [channel_server].
//
// The structs are SI; every key's unit and range is in the .cc, where it is visited, and in --example.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "acoustics/fading/path_fading.h"
#include "acoustics/fading/reverberation.h"
#include "acoustics/noise/noise_table_reader.h"
#include "acoustics/noise/noise_variation.h"
#include "acoustics/rays/arrivals.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/noise.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "bus/config/config.h"
#include "bus/runtime/scenario.h"
#include "channel_server/links/echo_plan.h"
#include "channel_server/links/link_predictor.h"
#include "channel_server/links/ray_query_client.h"
#include "channel_server/packets/packet_medium.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/ray_propagation.h"
#include "channel_server/propagation/reach.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/replay_config.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/state_history.h"
#include "channel_server/vehicles/vehicle_clocks.h"
#include "channel_server/vehicles/vehicle_equipment.h"
#include "channel_server/vehicles/vehicle_noise.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/files/file_path.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

// The source of temperature and salinity, or of speed.
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
  FilePath file, salinity_file;                    // salinity only where in a file of its own
  bool position_given = false;  // of the column of a gridded file; else the scenario's origin
  double latitude_rad = 0, longitude_rad = 0;
  std::int64_t time_index = 0;  // of a gridded file with several times
  // Where the source knows speeds only; absorption depends on them.
  acoustics::WaterSample assumed{10, 35};
};

struct EnvironmentConfig {
  ProfileConfig profile;
  std::string sound_speed_model = "mackenzie";
  std::string absorption_model = "francois-garrison";
  acoustics::NoiseSources noise{.wind_mps = 5};
  FilePath noise_file;  // instead of these
  acoustics::NoiseVariation noise_variation;
  double spreading_exponent = 1.5;
  double ph = 8.0;
};

enum class PropagationModel { kRays, kStraight };

// The bottom by name or by numbers; what rays look for.
struct PropagationConfig {
  PropagationModel model = PropagationModel::kRays;
  std::string sediment = "MediumSand";  // of acoustics/sea/boundary_reflection.h; "custom": the three numbers
  double bottom_density_ratio = 1.9, bottom_sound_speed_mps = 1650, bottom_attenuation_db = 0.8;
  std::string surface_loss_model = "apl-bubbles";
  std::string solver = "auto";                       // or images, snell, arcs
  acoustics::RayOptions options{.max_bounces = -1};  // below 0: by range over depth
  double min_amplitude_db = -160;
  double max_bounce_loss_db = 30;  // of all bounces of a path together
  double shadow_loss_db = 120;     // our choice; 0: none stated
  double diffuse_below_noise_db = 5, weak_below_diffuse_db = 6;
  double speed_tolerance_mps = 0.02, reuse_distance_m = 25;
  double least_depth_m = 0, greatest_depth_m = acoustics::kDeepestWater;
  bool reuse_for_packets = false, coherent = false;
  acoustics::FadingModel fading{.enabled = true};
  ReplayConfig replay;
  acoustics::Reverberation reverberation;
};

// One [[environment_change]]; what is not given stays as it was.
struct ChangeConfig {
  double at_s = 0;
  std::optional<double> wind_mps, shipping, sea_surface_z_m;
  std::optional<ProfileConfig> profile;
  std::optional<double> rain_mm_per_h = {};
};

// How the server works; defaults as in the headers of its parts.
inline constexpr int kMaxShards = 64;

struct ServerRules {
  SimDuration link_period = SimDuration::from_milliseconds(1000);  // between two LINKS of a vehicle
  PositionRule position;
  MediumRule medium;
  ReachRule reach;
  RayQueryRule ray_queries;
  int bottom_points = 9;  // under each link, for its echoes
  EchoRule echoes;
  SeabedRule seabed;
  double profile_reuse_distance_m = 25;  // between the places where bottom profiles of link tables end
  double row_reuse_distance_m = 0;       // over which rows of link tables are carried on (links/kept_rows.h)
  int max_searches_per_tick = 0;         // of paths, for link tables; 0: as many as they need
  int threads = 1;                       // that compute link tables
  int predicted_payload_bytes = 32;      // of the packets whose delivery link tables predict
};

struct ChannelServerConfig {
  struct OfVehicle {
    std::string name;
    bool has_modem = false;
    VehicleModem modem;
    bool carries_modem = true;  // false: a ship, a jammer
    bool is_transponder = false;
    std::optional<ClockSettings> clock;
    std::optional<NoiseOf> noise;
  };
  EnvironmentConfig environment;
  PropagationConfig propagation;
  std::vector<ChangeConfig> changes;
  VehicleModem modem;
  std::vector<OfVehicle> vehicles;
  ServerRules rules;
};

void visit(bus::ConfigVisitor& v, ChannelServerConfig& config);
// Its part that is about the water: [environment], [propagation] and [[environment_change]]
// (water_config.cc).
void visit_water(bus::ConfigVisitor& v, ChannelServerConfig& config);

// The keys of [environment] about noise.
void visit_noise(bus::ConfigVisitor& v, EnvironmentConfig& config);
// Its noise_file; empty without one. Throws InvalidArgument as acoustics::read_noise_table.
std::vector<acoustics::TimedSpectrum> noise_table(const EnvironmentConfig& config);
// The sources at the start, with the first of these.
acoustics::NoiseSources noise_sources(const EnvironmentConfig& config);

// The water of a scenario. Throws InvalidArgument when a profile cannot be read or
// is impossible.
acoustics::Environment make_environment(const EnvironmentConfig& config, const bus::Scenario& scenario);

// Puts the ocean's field that the scenario names, where sound goes through it, and its profile at the world's
// origin into the environment. Throws InvalidArgument when it cannot be.
void set_field(const bus::Scenario& scenario, acoustics::Environment& environment);

// Its profile of sound speed. Throws likewise.
acoustics::SoundSpeedProfile make_profile(const EnvironmentConfig& config, const bus::Scenario& scenario);

// Rays as configured. Throws InvalidArgument when a part is out of range.
RayModel make_rays(const ChannelServerConfig& config);

ConfiguredModems make_modems(const ChannelServerConfig& config);

// The rules with what other sections say of them: seed, fading, the noise that varies.
ServerRules make_rules(const ChannelServerConfig& config, const bus::Scenario& scenario);

// Of the vehicles that have some.
VehicleEquipment make_equipment(const ChannelServerConfig& config, const bus::Scenario& scenario);

// What link tables predict of packets, with the profiles of models/modems.
LinkPredictor make_predictor(const ServerRules& rules);

}  // namespace halocline::channel_server
