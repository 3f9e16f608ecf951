#include "channel_server/channel_server_config.h"

#include <filesystem>

#include "acoustics/profile_reader.h"
#include "channel_server/modem_config.h"
#include "core/check.h"

namespace halocline::channel_server {
namespace {

const std::vector<std::string> kProfileSources{"global-mean",  "global-mean-salinity-35",
                                               "harris-zorzi", "munk",
                                               "isovelocity",  "water-table",
                                               "speed-table",  "file"};

// LCM carries more, but a table a minute is no table and 50 Hz of a large fleet is a flood.
constexpr double kLeastLinkRateHz = 1.0 / 60, kGreatestLinkRateHz = 50;

template <class Count>
void visit_count(bus::ConfigVisitor& v, std::string_view key, Count& value, const bus::NumberRule& rule) {
  bus::integer_as(v, key, value, rule);
}

acoustics::SoundSpeedProfile water_table(const ProfileConfig& config, acoustics::SoundSpeedModel model,
                                         double latitude_rad) {
  std::vector<acoustics::WaterRow> rows;
  for (const Vec3& row : config.water_rows) rows.push_back({row.x(), row.y(), row.z()});
  return acoustics::SoundSpeedProfile::from_water(std::move(rows), model, latitude_rad);
}

acoustics::SoundSpeedProfile speed_table(const ProfileConfig& config) {
  std::vector<acoustics::SpeedRow> rows;
  for (std::size_t i = 0; i < config.speeds_mps.size(); ++i) {
    rows.push_back({config.speed_depths_m.at(i), config.speeds_mps[i]});
  }
  return acoustics::SoundSpeedProfile::from_speeds(std::move(rows), config.assumed);
}

void check_tables(bus::ConfigVisitor& v, const ProfileConfig& p) {
  if (p.source == ProfileSource::kWaterTable) {
    bus::report_refusal(v, "water_rows",
                        [&] { water_table(p, acoustics::SoundSpeedModel::kMackenzie1981, 0); });
  }
  if (p.source != ProfileSource::kSpeedTable) return;
  if (p.speeds_mps.size() != p.speed_depths_m.size()) {
    return v.problem("speeds_mps", "profile = \"speed-table\" needs as many speeds as speed_depths_m");
  }
  bus::report_refusal(v, "speeds_mps", [&] { speed_table(p); });
}

void visit_tables(bus::ConfigVisitor& v, ProfileConfig& p) {
  v.points("water_rows", p.water_rows,
           {-1e5, 1e5, "", "water-table: rows of [depth m, temperature degC, salinity psu], depth rising"});
  v.numbers("speed_depths_m", p.speed_depths_m,
            {0, acoustics::kDeepestWater, "m", "speed-table: depths, rising"});
  v.numbers("speeds_mps", p.speeds_mps, {1000, 2000, "m/s", "speed-table: a speed for each depth"});
  v.number("isovelocity_mps", p.isovelocity_mps, {1000, 2000, "m/s", "isovelocity: the speed everywhere"});
  v.number("assumed_temperature_degc", p.assumed.temperature_degc,
           {-5, 45, "degC", "water of profiles that hold speeds only"});
  v.number("assumed_salinity_psu", p.assumed.salinity_psu,
           {0, 50, "psu", "water of profiles that hold speeds only"});
  check_tables(v, p);
}

void visit_file(bus::ConfigVisitor& v, ProfileConfig& p) {
  v.text("profile_file", p.file, {}, "file: CSV, or netCDF with temperature (and salinity)");
  v.text("profile_salinity_file", p.salinity_file, {},
         "file: netCDF with salinity, where it is another file");
  p.position_given = v.given("profile_latitude_deg") && v.given("profile_longitude_deg");
  bus::degrees(v, "profile_latitude_deg", p.latitude_rad,
               {-90, 90, "deg", "of the column in a gridded file; the scenario's origin unless given"});
  bus::degrees(v, "profile_longitude_deg", p.longitude_rad,
               {-180, 360, "deg", "of the column in a gridded file; the scenario's origin unless given"});
  v.integer("profile_time_index", p.time_index, {0, 1e6, "", "which of a gridded file's times, from 0"});
  if (p.source == ProfileSource::kFile && p.file.empty()) {
    v.problem("profile_file", "profile = \"file\" needs the name of a file");
  }
}

void visit_environment(bus::ConfigVisitor& v, EnvironmentConfig& e) {
  bus::choice(v, "profile", e.profile.source, kProfileSources, "where the sound-speed profile comes from");
  visit_tables(v, e.profile);
  visit_file(v, e.profile);
  v.text("sound_speed_model", e.sound_speed_model, bus::names_of(acoustics::kSoundSpeedModels),
         "formula of sound speed");
  v.text("absorption_model", e.absorption_model, bus::names_of(acoustics::kAbsorptionModels),
         "formula of absorption");
  v.number("wind_mps", e.noise.wind_mps, {0, 60, "m/s", "wind 10 m above the sea: noise"});
  v.number("shipping", e.noise.shipping, {0, 1, "", "shipping activity: noise"});
  v.number("spreading_exponent", e.spreading_exponent,
           {1, 2, "", "1 cylindrical, 1.5 practical, 2 spherical spreading"});
  v.number("acidity_ph", e.ph, {7, 9, "", "pH of the water: absorption"});
}

void visit_vehicle(bus::ConfigVisitor& v, ChannelServerConfig::OfVehicle& vehicle,
                   const VehicleModem& standard) {
  v.shared_with_others();
  v.text("name", vehicle.name, {}, "channel suffix");
  vehicle.has_modem = v.given("modem");
  if (!vehicle.has_modem) return;
  if (vehicle.modem == VehicleModem()) vehicle.modem = standard;
  v.section("modem", "Where it differs from [modem]",
            [&](bus::ConfigVisitor& modem) { visit_modem(modem, vehicle.modem); });
}

void visit_rules(bus::ConfigVisitor& v, ServerRules& r) {
  double rate_hz = 1 / r.link_period.seconds();
  v.number("link_rate_hz", rate_hz,
           {kLeastLinkRateHz, kGreatestLinkRateHz, "Hz", "link tables of each vehicle"});
  r.link_period = SimDuration::from_seconds(1 / rate_hz);
  bus::seconds(v, "state_lag_s", r.position.state_lag,
               {0, 10, "s", "how old a state must be to be used; longer than a message takes on the bus"});
  bus::seconds(v, "state_timeout_s", r.position.state_timeout,
               {0.01, 3600, "s", "a vehicle without a younger state leaves the tables"});
  bus::seconds(v, "greatest_lateness_s", r.medium.greatest_lateness,
               {0, 600, "s", "how long after its start a transmission may be heard of"});
  bus::seconds(v, "greatest_earliness_s", r.medium.greatest_earliness,
               {0, 3600, "s", "how long before its start a transmission may be announced"});
  visit_count(v, "bottom_points", r.bottom_points,
              {1, 64, "", "points of the bottom asked about for each link"});
  v.number("echo_reuse_distance_m", r.echo_reuse_distance_m,
           {0, 1e5, "m", "how far the ends of a link may move before its echoes are asked anew"});
  bus::seconds(v, "echo_deadline_s", r.asking.answer_deadline,
               {0.001, 60, "s", "the bathymetry service is away when it has not answered by then"});
  visit_count(v, "echo_rays_per_message", r.asking.rays_per_batch, {128, 4096, "", "rays in one RAY_QUERY"});
  visit_count(v, "echo_messages_in_flight", r.asking.batches_in_flight,
              {1, 64, "", "RAY_QUERYs without an answer"});
  visit_count(v, "echo_messages_per_table", r.asking.batches_per_tick,
              {1, 10000, "", "RAY_QUERYs for one link table"});
}

std::string path_in(const std::string& folder, const std::string& file) {
  return file.empty() ? file : (std::filesystem::path(folder) / file).string();
}

acoustics::SoundSpeedProfile profile_from_file(const EnvironmentConfig& config,
                                               acoustics::SoundSpeedModel model,
                                               const bus::Scenario& scenario, const std::string& folder) {
  const ProfileConfig& p = config.profile;
  const double latitude = p.position_given ? p.latitude_rad : to_radians(scenario.origin_latitude_deg);
  const double longitude = p.position_given ? p.longitude_rad : to_radians(scenario.origin_longitude_deg);
  const std::string path = path_in(folder, p.file), ending = std::filesystem::path(path).extension().string();
  if (ending == ".csv" || ending == ".txt") {
    return acoustics::read_profile(path, {model, latitude, p.assumed}, latitude, longitude);
  }
  return acoustics::read_grid_profile(
             {path, path_in(folder, p.salinity_file), latitude, longitude, static_cast<int>(p.time_index)},
             model)
      .profile;
}

acoustics::SoundSpeedProfile make_profile(const EnvironmentConfig& config, const bus::Scenario& scenario,
                                          const std::string& folder) {
  using Profile = acoustics::SoundSpeedProfile;
  const auto model = acoustics::sound_speed_model_from_name(config.sound_speed_model);
  require(model.has_value(), "no sound-speed model is called " + config.sound_speed_model);
  const ProfileConfig& p = config.profile;
  switch (p.source) {
    case ProfileSource::kGlobalMean:
      return Profile::global_mean(*model);
    case ProfileSource::kGlobalMeanOfSalinity35:
      return Profile::global_mean_of_salinity_35(*model);
    case ProfileSource::kHarrisZorzi:
      return Profile::harris_zorzi(*model);
    case ProfileSource::kMunk:
      return Profile::munk(p.assumed);
    case ProfileSource::kIsovelocity:
      return Profile::isovelocity(p.isovelocity_mps, p.assumed);
    case ProfileSource::kWaterTable:
      return water_table(p, *model, to_radians(scenario.origin_latitude_deg));
    case ProfileSource::kSpeedTable:
      return speed_table(p);
    case ProfileSource::kFile:
      break;
  }
  return profile_from_file(config, *model, scenario, folder);
}

}  // namespace

void visit(bus::ConfigVisitor& v, ChannelServerConfig& config) {
  v.section("environment", "The water",
            [&](bus::ConfigVisitor& s) { visit_environment(s, config.environment); });
  v.section("modem", "The modem of every vehicle without one of its own",
            [&](bus::ConfigVisitor& s) { visit_modem(s, config.modem); });
  v.list(
      "vehicle", "A vehicle", config.vehicles.size(), [&](std::size_t n) { config.vehicles.resize(n); },
      [&](bus::ConfigVisitor& item, std::size_t i) {
        visit_vehicle(item, config.vehicles[i], config.modem);
      });
  v.section("channel_server", "How the channel server works",
            [&](bus::ConfigVisitor& s) { visit_rules(s, config.rules); });
}

acoustics::Environment make_environment(const EnvironmentConfig& config, const bus::Scenario& scenario,
                                        const std::string& folder) {
  const auto absorption = acoustics::absorption_model_from_name(config.absorption_model);
  require(absorption.has_value(), "no absorption model is called " + config.absorption_model);
  acoustics::Environment environment;
  environment.profile = make_profile(config, scenario, folder);
  environment.noise = config.noise;
  environment.spreading_exponent = config.spreading_exponent;
  environment.absorption_model = *absorption;
  environment.ph = config.ph;
  environment.latitude_rad = to_radians(scenario.origin_latitude_deg);
  environment.sea_surface_z_m = scenario.sea_surface_z_m;
  validate(environment);
  return environment;
}

ConfiguredModems make_modems(const ChannelServerConfig& config) {
  validate(config.modem.modem);
  ConfiguredModems modems{config.modem, {}};
  for (const auto& vehicle : config.vehicles) {
    if (!vehicle.has_modem) continue;
    validate(vehicle.modem.modem);
    modems.of_vehicle.emplace(vehicle.name, vehicle.modem);
  }
  return modems;
}

}  // namespace halocline::channel_server
