// SPDX-License-Identifier: BSD-3-Clause
// The channel server's part of a scenario file: [environment], [propagation], [[environment_change]],
// [modem], [vehicle.modem], [vehicle.clock], [vehicle.noise] and [channel_server].
//
// The structs hold SI units. The unit and range of each key stand in the .cc file that visits it, and in the
// output of --example.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "acoustics/fading/path_fading.h"
#include "acoustics/noise/noise_table_reader.h"
#include "acoustics/noise/noise_variation.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/ice_cover.h"
#include "acoustics/sea/noise.h"
#include "acoustics/sea/profile_drift.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "acoustics/sea/water_load.h"
#include "bus/config/config.h"
#include "bus/config/scenario.h"
#include "channel_server/detail.h"
#include "channel_server/links/link_predictor.h"
#include "channel_server/modems/modem_config.h"
#include "channel_server/packets/packet_medium.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/reach.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/propagation/surface_ends.h"
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

// The source of the sound-speed profile: temperature and salinity, or sound speed itself.
enum class ProfileSource {
  kGlobalMean,
  kGlobalMeanOfSalinity35,
  kHarrisZorzi,
  kMunk,
  kIsovelocity,
  kWaterTable,  // rows of depth, temperature, salinity in the scenario
  kFile,        // CSV, or netCDF at the scenario's origin
};

// The sound-speed profile. Members of other sources than `source` are not used.
struct ProfileConfig {
  ProfileSource source = ProfileSource::kGlobalMean;
  double isovelocity_mps = 1500;
  std::vector<Vec3> water_rows;  // depth m, temperature degC, salinity psu
  FilePath file, salinity_file;  // salinity_file only if salinity has a file of its own
  std::int64_t time_index = 0;   // used with a gridded file of several times
  // Temperature and salinity for absorption, when the source holds sound speeds only.
  acoustics::WaterSample assumed{10, 35};
};

// The noise place of scenarios that leave it to the depth of their water.
inline constexpr std::string_view kByDepth = "by-depth";

// The water of [environment].
struct EnvironmentConfig {
  ProfileConfig profile;
  std::string sound_speed_model = "mackenzie";
  std::string absorption_model = "francois-garrison";
  acoustics::NoiseSources noise{.wind_mps = 5};
  FilePath noise_file;  // a table of noise spectra that replaces `noise`
  // A kind of place (acoustics/noise/place_noise.h), or kByDepth; use_depth() replaces the latter by a kind,
  // and until then it adds nothing.
  std::string noise_place{kByDepth};
  FilePath site_noise_file;  // noise measured at the place, in the place of noise_place: a file, or
  std::vector<std::array<double, 2>> site_noise;  // rows of frequency, kHz, and level, dB re 1 uPa^2/Hz
  // Change of the profile over the upper water: drawn for members of ensembles, not read from a file.
  acoustics::DriftAmplitudes profile_modes;
  double profile_modes_depth_m = 200;
  acoustics::NoiseVariation noise_variation;
  double profile_spread_mps = 0;  // of ProfileDrift
  acoustics::WaterLoad load;
  double spreading_exponent = 1.5;
  double ph = 8.0;
  acoustics::IceCover ice;
};

// The model of propagation: eigenrays, or one straight path.
enum class PropagationModel { kRays, kStraight };

// Returns the ray model of a run at Detail::kExact, without its bottom and fading. Cells and lattices that
// links share move levels of link tables by 0.1 dB in the median and by 1 dB at one link in ten
// (docs/validation.md).
RayModel standard_rays();

// The bottom, by name or by numbers, and how sound propagates.
struct PropagationConfig {
  PropagationModel model = PropagationModel::kRays;
  // A name of acoustics/sea/boundary_reflection.h, or "custom" for the three numbers.
  std::string sediment = "MediumSand";
  double bottom_density_ratio = 1.9, bottom_sound_speed_mps = 1650, bottom_attenuation_db = 0.8;
  // Unlike the struct's, the scenario's default is a sea whose scattered sound turns to new angles.
  acoustics::FadingModel fading{.enabled = true, .bottom_roughness_m = 0.03, .turns = true};
  RayModel rays = standard_rays();  // its bottom and fading are replaced by those above
  ReplayConfig replay;
};

// One [[environment_change]]; a member without a value leaves its quantity unchanged.
struct ChangeConfig {
  double at_s = 0;
  std::optional<double> wind_mps, shipping, sea_surface_z_m;
  std::optional<ProfileConfig> profile;
  std::optional<double> rain_mm_per_h = {};
};

inline constexpr int kMaxShards = 64;

// The rules of the server; defaults as in the headers of its parts.
struct ServerRules {
  // Time between two LINKS messages of a vehicle.
  SimDuration link_period = SimDuration::from_milliseconds(1000);
  PositionRule position;
  MediumRule medium;
  ReachRule reach;
  SeabedRule seabed;
  int threads = 1;                   // threads that compute link tables and the paths of packets
  int predicted_payload_bytes = 32;  // payload of the packets whose delivery link tables predict
  // Noise by which receivers do worse than their profiles in forecasts, dB; negative: better. Drawn for
  // members of ensembles, not read from a file.
  double receiver_margin_db = 0;
};

// What a calibration changes in all modems: those of vehicles and their rates, too.
struct ReceiverCalibration {
  double loss_db = 0;      // added to Modem::receiver_loss
  double echo_factor = 1;  // on Modem::late_echo_share
};

// The whole configuration of the channel server.
struct ChannelServerConfig {
  struct OfVehicle {
    std::string name;
    bool has_modem = false;
    VehicleModem modem;
    bool carries_modem = true;  // false for a ship or a jammer
    bool is_transponder = false;
    bool own_noise = true;  // the noise of a propeller, where the vehicle's model has one
    std::optional<ClockSettings> clock;
    std::optional<NoiseSource> noise;
  };
  Detail detail = Detail::kExact;  // its constants are already in `propagation` and `rules`
  EnvironmentConfig environment;
  PropagationConfig propagation;
  std::vector<ChangeConfig> changes;
  VehicleModem modem = load_modem(kGenericProfile);  // coded and hopped, unlike the struct's ideal default
  std::vector<OfVehicle> vehicles;
  ReceiverCalibration calibration;
  ServerRules rules;
};

// Visits every key of the configuration.
void visit(bus::ConfigVisitor& v, ChannelServerConfig& config);
// Sets the slow sea (docs/packets.md) that a scenario has where it says nothing of it; the structs are
// without.
void set_slow_sea(ChannelServerConfig& config);
void visit_propagation(bus::ConfigVisitor& v, PropagationConfig& propagation);
// Visits [environment], [propagation] and [[environment_change]] (water_config.cc). When it reads, it begins
// with set_slow_sea(). Slow noise and drift that the scenario does not give are off without fading = "sea",
// drift also where an ocean field carries sound.
void visit_water(bus::ConfigVisitor& v, ChannelServerConfig& config);

// Returns the spectra of noise_file; empty without a file. Throws InvalidArgument as
// acoustics::read_noise_table does.
std::vector<acoustics::TimedSpectrum> noise_table(const EnvironmentConfig& config);
// True when the noise of the place is left to the depth of the water.
bool needs_depth(const EnvironmentConfig& config);
// Sets the place that is left to the depth: below fast ice that, a shelf in water of up to 500 m, else open.
void use_depth(double depth_m, EnvironmentConfig& config);

// Returns the noise sources at the start, with the first spectrum of noise_file.
acoustics::NoiseSources noise_sources(const EnvironmentConfig& config);

// Returns the water of a scenario. Throws InvalidArgument when a profile cannot be read or is impossible.
acoustics::Environment make_environment(const EnvironmentConfig& config, const bus::Scenario& scenario);

// Sets the environment's ocean field to the one that the scenario names, if sound is to pass through it, and
// its profile to that at the world's origin. Throws InvalidArgument when the field cannot be used.
void set_field(const bus::Scenario& scenario, acoustics::Environment& environment);

// Returns the sound-speed profile of a scenario. Throws InvalidArgument when it cannot be read or is
// impossible.
acoustics::SoundSpeedProfile make_profile(const EnvironmentConfig& config, const bus::Scenario& scenario);

// Returns the configured ray model. Throws InvalidArgument when a parameter is out of range.
RayModel make_rays(const ChannelServerConfig& config);

// Returns the configured fading, with what the ice changes in it.
acoustics::FadingModel fading_of(const ChannelServerConfig& config);

// Returns the ends of a scenario's links among its waves; empty where nothing near the surface acts on sound:
// along straight paths, without fading, and with scattering = "none".
std::optional<SurfaceEnds> make_surface_ends(const ChannelServerConfig& config,
                                             const bus::Scenario& scenario);

// Returns the scenario's modem and those of its vehicles, with what the calibration changes in them.
ConfiguredModems make_modems(const ChannelServerConfig& config);

// Returns the variation of the ambient noise: the configured one, with what the place adds. A reef is louder
// by night, and snaps and cracks are a part of their place's noise. Noon is 12 h local solar time of [ocean]
// start_date; without that date a run starts at noon.
acoustics::NoiseVariation make_noise_variation(const EnvironmentConfig& config,
                                               const bus::Scenario& scenario);

// Returns the rules with the values that other sections give: seed, fading, and variation of the noise.
ServerRules make_rules(const ChannelServerConfig& config, const bus::Scenario& scenario);

// Returns the clocks, noise sources, batteries and transponders of the vehicles that have them.
VehicleEquipment make_equipment(const ChannelServerConfig& config, const bus::Scenario& scenario);

// Returns the predictor of link tables, with the profiles of models/modems.
LinkPredictor make_predictor(const ServerRules& rules);

}  // namespace halocline::channel_server
