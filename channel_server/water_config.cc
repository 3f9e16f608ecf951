// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "acoustics/fading/path_fading.h"
#include "acoustics/fading/slow_fading.h"
#include "acoustics/noise/noise_variation.h"
#include "acoustics/noise/place_noise.h"
#include "acoustics/prediction/steady_band.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/fine_structure.h"
#include "acoustics/sea/ice_cover.h"
#include "acoustics/sea/profile_drift.h"
#include "acoustics/sea/profile_reader.h"
#include "acoustics/sea/sound_speed.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "acoustics/sea/water_load.h"
#include "bus/config/carried_files.h"
#include "bus/config/config.h"
#include "bus/config/scenario.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/detail.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/surface_ends.h"
#include "core/check.h"
#include "core/elementary.h"
#include "core/frames.h"
#include "core/units.h"

namespace halocline::channel_server {
namespace {

const std::vector<std::string> kProfileSources{
    "global-mean", "global-mean-salinity-35", "harris-zorzi", "munk", "isovelocity", "water-table", "file"};
// Keys of [environment] that [[environment_change]] has, too.
const bus::NumberRule kWind{0, 60, "m/s", "wind speed 10 m above the sea: noise, waves and bubbles"};
const bus::NumberRule kShipping{0, 1, "", "shipping activity: noise"};
const bus::NumberRule kRain{0, 500, "mm/h", "rain rate: noise"};

acoustics::SoundSpeedProfile water_table(const ProfileConfig& config, acoustics::SoundSpeedModel model,
                                         double latitude_rad) {
  std::vector<acoustics::WaterRow> rows;
  for (const Vec3& row : config.water_rows) rows.push_back({row.x(), row.y(), row.z()});
  return acoustics::SoundSpeedProfile::from_water(std::move(rows), model, latitude_rad);
}

void check_water_rows(bus::ConfigVisitor& v, const ProfileConfig& p) {
  if (p.source != ProfileSource::kWaterTable) return;
  bus::report_refusal(v, "water_rows",
                      [&] { water_table(p, acoustics::SoundSpeedModel::kMackenzie1981, 0); });
}

// Visits keys that only some sources use.
void with_profile(bus::ConfigVisitor& v, const ProfileConfig& p, std::initializer_list<ProfileSource> sources,
                  const std::function<void()>& body) {
  bus::when_one_of(v, "profile", p.source, kProfileSources, sources, body);
}

void visit_given_water(bus::ConfigVisitor& v, ProfileConfig& p) {
  using Source = ProfileSource;
  with_profile(v, p, {Source::kWaterTable}, [&] {
    v.points("water_rows", p.water_rows,
             {-1e5, 1e5, "", "profile as rows of [depth m, temperature degC, salinity psu], depth rising"});
  });
  with_profile(v, p, {Source::kIsovelocity}, [&] {
    v.number("isovelocity_mps", p.isovelocity_mps, {1000, 2000, "m/s", "sound speed at all depths"});
  });
  with_profile(v, p, {Source::kMunk, Source::kIsovelocity, Source::kFile}, [&] {
    v.number("assumed_temperature_degc", p.assumed.temperature_degc,
             {-5, 45, "degC", "temperature for absorption, where the profile holds sound speeds only"});
    v.number("assumed_salinity_psu", p.assumed.salinity_psu,
             {0, 50, "psu", "salinity for absorption, where the profile holds sound speeds only"});
  });
  check_water_rows(v, p);
}

void visit_file(bus::ConfigVisitor& v, ProfileConfig& p) {
  v.file("profile_file", p.file, bus::FileNames::kFiles,
         "profile as CSV, or as netCDF with temperature and salinity, whose column at the origin is taken");
  v.file("profile_salinity_file", p.salinity_file, bus::FileNames::kFiles,
         "salinity as netCDF, where it has a file of its own");
  v.integer("profile_time_index", p.time_index,
            {0, 1e6, "", "index from 0 among the times of a netCDF profile_file"});
  if (p.source != ProfileSource::kFile) return;
  bus::require_readable(v, "profile_file", p.file);
  if (!p.salinity_file.empty()) bus::require_readable(v, "profile_salinity_file", p.salinity_file);
}

void visit_profile(bus::ConfigVisitor& v, ProfileConfig& p) {
  bus::choice(v, "profile", p.source, kProfileSources, "source of the sound-speed profile");
  visit_given_water(v, p);
  with_profile(v, p, {ProfileSource::kFile}, [&] { visit_file(v, p); });
}

std::vector<std::string> noise_places() {
  std::vector<std::string> names = bus::names_of(acoustics::kNoisePlaces);
  names.emplace_back(kByDepth);
  return names;
}

// Visits the noise measured at the place: a file's name or rows, under one key.
void visit_site_noise(bus::ConfigVisitor& v, EnvironmentConfig& e) {
  constexpr std::string_view kKey = "site_noise";
  if (v.writing() ? !e.site_noise_file.empty() : v.is_text(kKey)) {
    v.file(kKey, e.site_noise_file, bus::FileNames::kFiles,
           "noise measured at the place, in the place of noise_place, as CSV of frequency_khz, level_db");
    if (!e.site_noise_file.empty()) bus::require_readable(v, kKey, e.site_noise_file);
    return;
  }
  v.pairs(kKey, e.site_noise,
          {-200, 1000, "",
           "noise measured at the place, in the place of noise_place: rows of [frequency kHz, level dB re 1 "
           "uPa^2/Hz], or a CSV file of frequency_khz, level_db; empty: none"});
}

// A place differs from the level of its kind by +-6 dB.
void visit_place(bus::ConfigVisitor& v, EnvironmentConfig& e) {
  v.text("noise_place", e.noise_place, noise_places(),
         "kind of place whose noise adds to that of wind, ships and rain, +-6 dB (docs/scenarios.md); "
         "by-depth: shelf in water of up to 500 m, else open, as with fading = \"none\"");
  visit_site_noise(v, e);
  if (!v.writing() && !e.site_noise.empty()) bus::report_refusal(v, "site_noise", [&] { noise_sources(e); });
}

void visit_load(bus::ConfigVisitor& v, acoustics::WaterLoad& load) {
  v.number("particles_kg_m3", load.particles_kg_m3,
           {0, 100, "kg/m^3", "mass of suspended mineral particles; they absorb sound (Urick 1948)"});
  v.when(load.particles_kg_m3 > 0, "particles_kg_m3 above 0", [&] {
    double radius_um = load.particle_radius_m * 1e6;
    v.number("particle_um", radius_um, {0.1, 1000, "um", "radius of the particles"});
    load.particle_radius_m = radius_um / 1e6;
  });
  v.number("plants_db_per_km", load.plants_db_per_km,
           {0, 1000, "dB/km", "absorption by plants in the water, as over a meadow of seagrass"});
}

void visit_noise(bus::ConfigVisitor& v, EnvironmentConfig& e) {
  v.number("wind_mps", e.noise.wind_mps, kWind);
  v.file("noise_file", e.noise_file, bus::FileNames::kFiles,
         "ambient noise as CSV of t_s, frequency_khz, level_db, in the place of wind, shipping and rain; "
         "empty: none");
  if (!e.noise_file.empty()) bus::require_readable(v, "noise_file", e.noise_file);
  v.when(e.noise_file.empty(), "no noise_file", [&] {
    v.number("shipping", e.noise.shipping, kShipping);
    v.number("rain_mm_per_h", e.noise.rain_mm_per_h, kRain);
    visit_place(v, e);
  });
  v.number("noise_offset_db", e.noise.offset_db,
           {-60, 60, "dB", "level added to the ambient noise, such as halocline calibrate finds it"});
  acoustics::NoiseVariation& n = e.noise_variation;
  v.number("noise_spread_db", n.spread_db,
           {0, 30, "dB", "standard deviation of the ambient noise over time; 0: none"});
  v.when(n.spread_db > 0, "noise_spread_db above 0", [&] {
    v.number("noise_spread_s", n.spread_time_s, {0.1, 1e6, "s", "correlation time of the ambient noise"});
  });
  v.number("impulse_exponent", n.burst_exponent,
           {0, 2, "", "exponent of impulsive, alpha-stable noise, 0.5 to 2; 0: no impulses"});
  v.when(n.burst_exponent > 0, "impulse_exponent above 0", [&] {
    v.number("impulse_level_db", n.burst_level.value,
             {-100, 100, "dB", "scale of impulsive noise over the ambient noise"});
  });
  bus::report_refusal(v, "impulse_exponent", [&] { validate(n); });
}

void visit_environment(bus::ConfigVisitor& v, EnvironmentConfig& e) {
  visit_profile(v, e.profile);
  v.text("sound_speed_model", e.sound_speed_model, bus::names_of(acoustics::kSoundSpeedModels),
         "formula of sound speed");
  v.text("absorption_model", e.absorption_model, bus::names_of(acoustics::kAbsorptionModels),
         "formula of absorption");
  v.number("profile_spread_mps", e.profile_spread_mps,
           {0, 10, "m/s", "standard deviation of the upper profile's sound speed over hours; 0: none"});
  visit_noise(v, e);
  v.number("spreading_exponent", e.spreading_exponent,
           {1, 2, "", "spreading along a straight path: 1 cylindrical, 1.5 practical, 2 spherical"});
}

const std::vector<std::string> kIceCovers{"none", "fast", "pack"};

void visit_ice(bus::ConfigVisitor& v, acoustics::IceCover& ice) {
  bus::choice(v, "cover", ice.kind, kIceCovers,
              "ice in the place of waves and bubbles: none, fast ice that stands still, or drifting pack");
  bus::when_one_of(
      v, "cover", ice.kind, kIceCovers, {acoustics::IceKind::kFast, acoustics::IceKind::kPack}, [&] {
        v.number("roughness_m", ice.roughness_m, {0, 5, "m", "rms height of the ice's lower face"});
        v.number("slope", ice.slope, {0, 1, "", "rms slope of the ice's lower face in a plane"});
        v.number("loss_db", ice.loss_db, {0, 20, "dB", "loss of sound to the ice at a bounce"});
        v.number("loss_per_sine_db", ice.loss_per_sine_db,
                 {0, 50, "dB", "further loss at a bounce, times the sine of the grazing angle"});
        v.number("keels_per_km", ice.keels_per_km, {0, 100, "1/km", "keels of the ice along a link"});
        v.number("keel_draft_m", ice.keel_draft_m,
                 {0, 60, "m", "draft of a keel, which takes draft / depth of the power that passes"});
      });
}

void visit_optional(bus::ConfigVisitor& v, std::string_view key, std::optional<double>& value,
                    const bus::NumberRule& rule) {
  if (v.writing() ? !value.has_value() : !v.given(key)) return;
  double number = value.value_or(0);
  v.number(key, number, rule);
  value = number;
}

constexpr std::array<std::string_view, 7> kKeysOfAProfile{
    "water_rows",   "isovelocity_mps",       "assumed_temperature_degc", "assumed_salinity_psu",
    "profile_file", "profile_salinity_file", "profile_time_index"};

// Visits the keys that [environment] has, too.
void visit_changed_water(bus::ConfigVisitor& v, ChangeConfig& c) {
  visit_optional(v, "wind_mps", c.wind_mps, kWind);
  visit_optional(v, "shipping", c.shipping, kShipping);
  visit_optional(v, "rain_mm_per_h", c.rain_mm_per_h, kRain);
  if (v.writing() ? !c.profile.has_value() : !v.given("profile")) {
    for (const std::string_view key : kKeysOfAProfile) {
      if (!v.writing() && v.given(key)) v.problem(key, "it needs a profile in the same table");
    }
    return;
  }
  ProfileConfig profile = c.profile.value_or(ProfileConfig());
  visit_profile(v, profile);
  c.profile = profile;
}

void visit_change(bus::ConfigVisitor& v, ChangeConfig& c) {
  v.number("at_s", c.at_s, {0, 1e9, "s", "simulation time from which the change holds"});
  visit_optional(v, "sea_surface_z_m", c.sea_surface_z_m, {-100, 100, "m", "z of the surface"});
  v.listed_elsewhere([&] { visit_changed_water(v, c); });
}

acoustics::SoundSpeedProfile profile_from_file(const EnvironmentConfig& config,
                                               acoustics::SoundSpeedModel model,
                                               const bus::Scenario& scenario) {
  const ProfileConfig& p = config.profile;
  const double latitude = to_radians(scenario.origin_latitude_deg);
  const double longitude = to_radians(scenario.origin_longitude_deg);
  const std::string& path = p.file.place();
  if (acoustics::is_profile_table(path)) {
    return acoustics::read_profile(path, {model, latitude, p.assumed}, latitude, longitude);
  }
  return acoustics::read_grid_profile(
             {path, p.salinity_file.place(), latitude, longitude, static_cast<int>(p.time_index)}, model)
      .profile;
}

// Keys of the slow sea in [environment] that a scenario gives.
struct GivenSlowSea {
  bool noise = false, profile = false;
};

// True when the scenario's ocean field carries sound. The keys belong to bus/config/scenario.h.
bool has_ocean_of_sound(bus::ConfigVisitor& v) {
  bool has_file = false, carries_sound = true;
  v.section("ocean", "", [&](bus::ConfigVisitor& s) {
    s.shared_with_others();
    has_file = s.given("file");
    if (has_file) s.boolean("carries_sound", carries_sound, "");
  });
  return has_file && carries_sound;
}

// Switches off slow noise and drift that the scenario does not give, where nothing fades; drift also where an
// ocean field has changes of its own.
void leave_out_slow_sea(bus::ConfigVisitor& v, const GivenSlowSea& given, ChannelServerConfig& config) {
  const bool fades = config.propagation.fading.enabled;
  if (!given.noise && !fades) config.environment.noise_variation.spread_db = 0;
  if (!given.profile && (!fades || has_ocean_of_sound(v))) config.environment.profile_spread_mps = 0;
}

acoustics::SoundSpeedProfile stated_profile(const EnvironmentConfig& config, const bus::Scenario& scenario) {
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
    case ProfileSource::kFile:
      break;
  }
  return profile_from_file(config, *model, scenario);
}

}  // namespace

acoustics::SoundSpeedProfile make_profile(const EnvironmentConfig& config, const bus::Scenario& scenario) {
  const acoustics::SoundSpeedProfile profile = stated_profile(config, scenario);
  return config.profile_modes.any()
             ? profile.with_change(drift_rows(config.profile_modes_depth_m, config.profile_modes))
             : profile;
}

void set_slow_sea(ChannelServerConfig& config) {
  config.environment.noise_variation.spread_db = 3;
  config.environment.noise_variation.spread_time_s = 3600;
  config.environment.profile_spread_mps = 0.3;
  config.propagation.fading.slow = {.deviation_db = 3, .time_s = 21600, .tidal_db = 1, .daily_db = 1};
}

void visit_water(bus::ConfigVisitor& v, ChannelServerConfig& config) {
  if (!v.writing()) set_slow_sea(config);
  GivenSlowSea given;
  v.section("environment", "Water, weather and ambient noise", [&](bus::ConfigVisitor& s) {
    visit_environment(s, config.environment);
    given = {s.given("noise_spread_db"), s.given("profile_spread_mps")};
  });
  v.section("water_load", "Load of the water that absorbs sound: particles and plants",
            [&](bus::ConfigVisitor& s) { visit_load(s, config.environment.load); });
  v.section("ice", "Ice on the water", [&](bus::ConfigVisitor& s) { visit_ice(s, config.environment.ice); });
  v.section("propagation", "Propagation of sound",
            [&](bus::ConfigVisitor& s) { visit_propagation(s, config.propagation); });
  if (!v.writing()) leave_out_slow_sea(v, given, config);
  // A sea that does not fade is a still one, of which only what is stated is noisy.
  if (!v.writing() && !config.propagation.fading.enabled && config.environment.noise_place == kByDepth)
    config.environment.noise_place = to_name(acoustics::NoisePlace::kOpen);
  v.list(
      "environment_change",
      "Change of the sea at a time, with keys of [environment]: wind, shipping, rain and profile",
      config.changes.size(), [&](std::size_t n) { config.changes.resize(n); },
      [&](bus::ConfigVisitor& item, std::size_t i) { visit_change(item, config.changes[i]); });
}

namespace {

// Returns the depth to which the profile drifts: of the water, where the terrain is a shape, or else of the
// profile's last row, if that is less than ProfileDrift::kDeepestM.
double drifting_depth_m(const acoustics::SoundSpeedProfile& profile, const bus::Scenario& scenario) {
  constexpr double kDeepest = acoustics::ProfileDrift::kDeepestM;
  const std::vector<double> rows = profile.row_depths_m();
  const double last_m = rows.size() > 1 ? rows.back() : kDeepest;
  const double depth_m = scenario.water_depth_m > 0 ? scenario.water_depth_m : last_m;
  return std::clamp(depth_m, 1.0, kDeepest);
}

}  // namespace

acoustics::Environment make_environment(const EnvironmentConfig& config, const bus::Scenario& scenario) {
  const auto absorption = acoustics::absorption_model_from_name(config.absorption_model);
  require(absorption.has_value(), "no absorption model is called " + config.absorption_model);
  acoustics::Environment environment;
  environment.profile = make_profile(config, scenario);
  environment.noise = noise_sources(config);
  environment.spreading_exponent = config.spreading_exponent;
  environment.absorption_model = *absorption;
  environment.ph = config.ph;
  environment.load = config.load;
  environment.latitude_rad = to_radians(scenario.origin_latitude_deg);
  environment.sea_surface_z_m = scenario.sea_surface_z_m;
  environment.tide = scenario.tide;
  environment.ice = config.ice;
  if (config.ice.covers()) environment.noise.wind_mps = 0;
  set_field(scenario, environment);
  environment.drift = {.spread_mps = config.profile_spread_mps,
                       .depth_m = drifting_depth_m(environment.profile, scenario),
                       .seed = scenario.seed};
  validate(environment);
  return environment;
}

}  // namespace halocline::channel_server
