// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "acoustics/fading/path_fading.h"
#include "acoustics/fading/reverberation.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/profile_reader.h"
#include "acoustics/sea/sound_speed.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "bus/config/carried_files.h"
#include "bus/config/config.h"
#include "bus/config/scenario.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/path_search.h"
#include "core/check.h"
#include "core/elementary.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::channel_server {
namespace {

const std::vector<std::string> kProfileSources{"global-mean",  "global-mean-salinity-35",
                                               "harris-zorzi", "munk",
                                               "isovelocity",  "water-table",
                                               "speed-table",  "file"};

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

// Visits keys that only some sources use.
void with_profile(bus::ConfigVisitor& v, const ProfileConfig& p, std::initializer_list<ProfileSource> sources,
                  const std::function<void()>& body) {
  bus::when_one_of(v, "profile", p.source, kProfileSources, sources, body);
}

void visit_tables(bus::ConfigVisitor& v, ProfileConfig& p) {
  using Source = ProfileSource;
  with_profile(v, p, {Source::kWaterTable}, [&] {
    v.points("water_rows", p.water_rows,
             {-1e5, 1e5, "", "water-table: rows of [depth m, temperature degC, salinity psu], depth rising"});
  });
  with_profile(v, p, {Source::kSpeedTable}, [&] {
    v.numbers("speed_depths_m", p.speed_depths_m,
              {0, acoustics::kDeepestWater, "m", "speed-table: depths, rising"});
    v.numbers("speeds_mps", p.speeds_mps, {1000, 2000, "m/s", "speed-table: a speed for each depth"});
  });
  with_profile(v, p, {Source::kIsovelocity}, [&] {
    v.number("isovelocity_mps", p.isovelocity_mps, {1000, 2000, "m/s", "isovelocity: the speed everywhere"});
  });
  with_profile(v, p, {Source::kMunk, Source::kIsovelocity, Source::kSpeedTable, Source::kFile}, [&] {
    v.number("assumed_temperature_degc", p.assumed.temperature_degc,
             {-5, 45, "degC", "water of profiles that hold speeds only"});
    v.number("assumed_salinity_psu", p.assumed.salinity_psu,
             {0, 50, "psu", "water of profiles that hold speeds only"});
  });
  check_tables(v, p);
}

void visit_file(bus::ConfigVisitor& v, ProfileConfig& p) {
  v.file("profile_file", p.file, bus::FileNames::kFiles,
         "file: CSV, or netCDF with temperature (and salinity)");
  v.file("profile_salinity_file", p.salinity_file, bus::FileNames::kFiles,
         "file: netCDF with salinity, where it is another file");
  p.position_given = v.given("profile_latitude_deg") && v.given("profile_longitude_deg");
  bus::degrees(v, "profile_latitude_deg", p.latitude_rad,
               {-90, 90, "deg", "of the column in a gridded file; the scenario's origin unless given"});
  bus::degrees(v, "profile_longitude_deg", p.longitude_rad,
               {-180, 360, "deg", "of the column in a gridded file; the scenario's origin unless given"});
  v.integer("profile_time_index", p.time_index, {0, 1e6, "", "which of a gridded file's times, from 0"});
  if (p.source != ProfileSource::kFile) return;
  bus::require_readable(v, "profile_file", p.file);
  if (!p.salinity_file.empty()) bus::require_readable(v, "profile_salinity_file", p.salinity_file);
}

void visit_profile(bus::ConfigVisitor& v, ProfileConfig& p) {
  bus::choice(v, "profile", p.source, kProfileSources, "where the sound-speed profile comes from");
  visit_tables(v, p);
  with_profile(v, p, {ProfileSource::kFile}, [&] { visit_file(v, p); });
}

void visit_environment(bus::ConfigVisitor& v, EnvironmentConfig& e) {
  visit_profile(v, e.profile);
  v.text("sound_speed_model", e.sound_speed_model, bus::names_of(acoustics::kSoundSpeedModels),
         "formula of sound speed");
  v.text("absorption_model", e.absorption_model, bus::names_of(acoustics::kAbsorptionModels),
         "formula of absorption");
  visit_noise(v, e);
  v.number("spreading_exponent", e.spreading_exponent,
           {1, 2, "", "1 cylindrical, 1.5 practical, 2 spherical spreading"});
  v.number("acidity_ph", e.ph, {7, 9, "", "pH of the water: absorption"});
}

const std::vector<std::string> kPropagationModels{"rays", "straight"};
const std::vector<std::string> kScattering{"none", "lambert"};  // values of scattering_loss and reverberation
constexpr std::string_view kCustom = "custom", kAnySolver = "auto";

std::vector<std::string> sediments() {
  std::vector<std::string> names{std::string(kCustom)};
  for (const std::string_view name : acoustics::sediment_names()) names.emplace_back(name);
  return names;
}

std::vector<std::string> surface_models() {
  using Model = acoustics::SurfaceModel;
  std::vector<std::string> names;
  for (const Model model :
       {Model::kFlat, Model::kAplBubbles, Model::kEckart, Model::kCoates, Model::kJones}) {
    names.emplace_back(to_name(model));
  }
  return names;
}

void visit_boundaries(bus::ConfigVisitor& v, PropagationConfig& p) {
  v.text("sediment", p.sediment, sediments(),
         "rays: the bottom, by its name in APL-UW TR 9407, or by numbers");
  v.when(p.sediment == kCustom, "sediment = \"custom\"", [&] {
    v.number("bottom_density_ratio", p.bottom_density_ratio,
             {0.5, 10, "", "custom: density over the water's"});
    v.number("bottom_sound_speed_mps", p.bottom_sound_speed_mps, {500, 7000, "m/s", "custom"});
    v.number("bottom_attenuation_db_per_wavelength", p.bottom_attenuation_db, {0, 54, "dB", "custom"});
  });
  v.text("surface_loss_model", p.surface_loss_model, surface_models(),
         "rays: what the wind takes from a bounce at the surface");
}

// True for models that state the loss of the coherent part alone. With fading that part is not lost but
// scattered.
bool is_coherent_loss(std::string_view surface_model) {
  return surface_model != "flat" && surface_model != "apl-bubbles";
}

// Visits keys that the straight path ignores.
void with_rays(bus::ConfigVisitor& v, const PropagationConfig& p, const std::function<void()>& body) {
  bus::when_one_of(v, "model", p.model, kPropagationModels, {PropagationModel::kRays}, body);
}

void visit_rough_boundaries(bus::ConfigVisitor& v, acoustics::FadingModel& f) {
  v.number("bottom_roughness_m", f.bottom_roughness_m, {0, 1, "m", "fading: rms height of the bottom"});
  bus::choice(v, "scattering_loss", f.scattering_loss, kScattering,
              "fading: lambert: what rough boundaries scatter beyond the bottom's critical angle is lost");
}

void visit_fading(bus::ConfigVisitor& v, PropagationConfig& p) {
  acoustics::FadingModel& f = p.fading;
  bus::choice(
      v, "fading", f.enabled, {"none", "sea"},
      "sea: paths fade by waves, rough bottom and medium (docs/packets.md); none: powers of paths add");
  v.when(f.enabled, "fading = \"sea\"", [&] {
    v.number("rice_factor_db", f.rice_factor_db,
             {-20, 60, "dB", "fading: steady over varying power of the medium"});
    v.number("medium_coherence_s", f.medium_coherence_s,
             {0.1, 1e6, "s", "fading: coherence time of the medium"});
    v.number("large_scale_fading_db", f.large_scale_db,
             {0, 20, "dB", "fading: standard deviation of a link's level over minutes"});
    v.when(f.large_scale_db > 0, "large_scale_fading_db above 0", [&] {
      v.number("large_scale_fading_s", f.large_scale_time_s, {0.1, 1e6, "s", "fading: its correlation time"});
    });
    with_rays(v, p, [&] { visit_rough_boundaries(v, f); });
  });
  if (f.enabled && is_coherent_loss(p.surface_loss_model)) {
    v.problem("surface_loss_model",
              "with fading = \"sea\" a rough surface scatters the coherent sound and loses nothing; allowed "
              "are \"flat\" and \"apl-bubbles\", or fading = \"none\"");
  }
}

void visit_reverberation(bus::ConfigVisitor& v, PropagationConfig& p) {
  acoustics::Reverberation& r = p.reverberation;
  bus::choice(v, "reverberation", r.enabled, kScattering,
              "rays: lambert: rough boundaries leave a tail behind every packet (docs/scenarios.md)");
  v.when(r.enabled, "reverberation = \"lambert\"", [&] {
    v.number("bottom_scattering_db", r.bottom_scattering_db,
             {-80, -5, "dB", "reverberation: of the bottom, by Lambert's law"});
    v.number("surface_scattering_db", r.surface_scattering_db,
             {-80, -5, "dB", "reverberation: of the surface, likewise"});
    v.number("reverberation_bounce_loss_db", r.bounce_loss_db,
             {0.01, 100, "dB", "reverberation: that the tail loses at each bounce off the bottom"});
  });
  if (r.enabled && !p.fading.enabled) v.problem("reverberation", "\"lambert\" needs fading = \"sea\"");
}

void visit_rays(bus::ConfigVisitor& v, PropagationConfig& p) {
  visit_boundaries(v, p);
  v.text("solver", p.solver, {std::string(kAnySolver), "images", "snell", "arcs"},
         "rays: how paths are found, where that way can; auto: the simplest that is exact");
  bus::integer_as(
      v, "max_bounces", p.options.max_bounces,
      {-1, 10'000, "", "rays: surface and bottom together; -1: 0.6 of range over depth, 60 at least"});
  bus::degrees(v, "max_launch_angle_deg", p.options.max_launch_angle_rad,
               {0.1, 90, "deg", "rays: of paths that bounce, from the horizontal"});
  v.number("min_amplitude_db", p.min_amplitude_db,
           {-400, 0, "dB re 1 m", "rays: of a path by spreading and bounces; weaker ones are dropped"});
  v.number("max_bounce_loss_db", p.max_bounce_loss_db,
           {1, 200, "dB", "rays: of all bounces beyond those of the strongest path; others are dropped"});
  v.number("diffuse_below_db", p.options.diffuse_below_db,
           {0, 100, "dB", "rays: over a rough bottom weaker paths come as their power alone; 0: none"});
  v.number("diffuse_below_noise_db", p.diffuse_below_noise_db,
           {-100, 100, "dB", "rays: the same of paths this much below the noise"});
  v.number("weak_below_diffuse_db", p.weak_below_diffuse_db,
           {-100, 100, "dB", "rays: the same of links of 10 depths and more this much weaker still"});
  v.number("speed_tolerance_mps", p.speed_tolerance_mps,
           {0, 1, "m/s", "rays: water rows within this of the line between their neighbours are left out"});
  v.number("reuse_distance_m", p.reuse_distance_m,
           {0, 1000, "m", "rays, link tables: length of cells whose links share a search; 0: none"});
  v.number("least_depth_m", p.least_depth_m,
           {0, acoustics::kDeepestWater, "m", "rays: of the water anywhere; more shortens the reach"});
  v.number("greatest_depth_m", p.greatest_depth_m,
           {0, acoustics::kDeepestWater, "m", "rays: of the water anywhere"});
  v.when(p.reuse_distance_m > 0, "reuse_distance_m above 0", [&] {
    v.boolean("reuse_for_packets", p.reuse_for_packets, "rays: packets share these searches, too");
  });
  v.number("shadow_loss_db", p.shadow_loss_db,
           {0, 400, "dB", "rays: transmission loss in a shadow; 0: nothing is received"});
}

void visit_propagation(bus::ConfigVisitor& v, PropagationConfig& p) {
  bus::choice(v, "model", p.model, kPropagationModels,
              "rays where the bottom is known, or one straight path (the paper's)");
  with_rays(v, p, [&] { visit_rays(v, p); });
  visit_fading(v, p);
  with_rays(v, p, [&] {
    visit_reverberation(v, p);
    v.when(!p.fading.enabled, "fading = \"none\"", [&] {
      v.boolean("coherent", p.coherent,
                "rays: add paths as phasors at the centre frequency, not their powers");
    });
  });
  visit_replay(v, p.replay);
}

void visit_optional(bus::ConfigVisitor& v, std::string_view key, std::optional<double>& value,
                    const bus::NumberRule& rule) {
  if (v.writing() ? !value.has_value() : !v.given(key)) return;
  double number = value.value_or(0);
  v.number(key, number, rule);
  value = number;
}

constexpr std::array<std::string_view, 11> kKeysOfAProfile{"water_rows",
                                                           "speed_depths_m",
                                                           "speeds_mps",
                                                           "isovelocity_mps",
                                                           "assumed_temperature_degc",
                                                           "assumed_salinity_psu",
                                                           "profile_file",
                                                           "profile_salinity_file",
                                                           "profile_latitude_deg",
                                                           "profile_longitude_deg",
                                                           "profile_time_index"};

void visit_change(bus::ConfigVisitor& v, ChangeConfig& c) {
  v.number("at_s", c.at_s, {0, 1e9, "s", "simulation time from which it holds"});
  visit_optional(v, "wind_mps", c.wind_mps, {0, 60, "m/s", "as in [environment]"});
  visit_optional(v, "shipping", c.shipping, {0, 1, "", "as in [environment]"});
  visit_optional(v, "rain_mm_per_h", c.rain_mm_per_h, {0, 500, "mm/h", "as in [environment]"});
  visit_optional(v, "sea_surface_z_m", c.sea_surface_z_m, {-100, 100, "m", "z of the surface"});
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

acoustics::SoundSpeedProfile profile_from_file(const EnvironmentConfig& config,
                                               acoustics::SoundSpeedModel model,
                                               const bus::Scenario& scenario) {
  const ProfileConfig& p = config.profile;
  const double latitude = p.position_given ? p.latitude_rad : to_radians(scenario.origin_latitude_deg);
  const double longitude = p.position_given ? p.longitude_rad : to_radians(scenario.origin_longitude_deg);
  const std::string& path = p.file.place();
  if (acoustics::is_profile_table(path)) {
    return acoustics::read_profile(path, {model, latitude, p.assumed}, latitude, longitude);
  }
  return acoustics::read_grid_profile(
             {path, p.salinity_file.place(), latitude, longitude, static_cast<int>(p.time_index)}, model)
      .profile;
}

}  // namespace

acoustics::SoundSpeedProfile make_profile(const EnvironmentConfig& config, const bus::Scenario& scenario) {
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
  return profile_from_file(config, *model, scenario);
}

void visit_water(bus::ConfigVisitor& v, ChannelServerConfig& config) {
  v.section("environment", "The water",
            [&](bus::ConfigVisitor& s) { visit_environment(s, config.environment); });
  v.section("propagation", "How sound goes through it",
            [&](bus::ConfigVisitor& s) { visit_propagation(s, config.propagation); });
  v.list(
      "environment_change", "The water changes; what is not given stays", config.changes.size(),
      [&](std::size_t n) { config.changes.resize(n); },
      [&](bus::ConfigVisitor& item, std::size_t i) { visit_change(item, config.changes[i]); });
}

acoustics::Environment make_environment(const EnvironmentConfig& config, const bus::Scenario& scenario) {
  const auto absorption = acoustics::absorption_model_from_name(config.absorption_model);
  require(absorption.has_value(), "no absorption model is called " + config.absorption_model);
  acoustics::Environment environment;
  environment.profile = make_profile(config, scenario);
  environment.noise = noise_sources(config);
  environment.spreading_exponent = config.spreading_exponent;
  environment.absorption_model = *absorption;
  environment.ph = config.ph;
  environment.latitude_rad = to_radians(scenario.origin_latitude_deg);
  environment.sea_surface_z_m = scenario.sea_surface_z_m;
  set_field(scenario, environment);
  validate(environment);
  return environment;
}

RayModel make_rays(const ChannelServerConfig& config) {
  const PropagationConfig& p = config.propagation;
  RayModel rays;
  const auto named = acoustics::sediment(p.sediment);
  require(named || p.sediment == kCustom, "no sediment is called " + p.sediment);
  rays.bottom = named ? *named
                      : acoustics::fluid_bottom(p.bottom_density_ratio, p.bottom_sound_speed_mps,
                                                p.bottom_attenuation_db);
  const auto surface = acoustics::surface_model_from_name(p.surface_loss_model);
  require(surface.has_value(), "no model of the surface is called " + p.surface_loss_model);
  rays.surface = *surface;
  rays.options = p.options;
  rays.bounces_follow_range = p.options.max_bounces < 0;
  rays.options.max_bounces = std::max(p.options.max_bounces, 0);
  rays.options.min_amplitude = elementary::exp10(p.min_amplitude_db / 20);
  rays.options.min_boundary_factor = elementary::exp10(-p.max_bounce_loss_db / 20);
  rays.speed_tolerance_mps = p.speed_tolerance_mps;
  rays.reuse_distance_m = p.reuse_distance_m;
  rays.least_depth_m = p.least_depth_m;
  rays.greatest_depth_m = p.greatest_depth_m;
  rays.reuse_for_packets = p.reuse_for_packets;
  rays.diffuse_below_noise = Decibels{p.diffuse_below_noise_db};
  rays.weak_below_diffuse = Decibels{p.weak_below_diffuse_db};
  rays.max_searches_per_tick = config.rules.max_searches_per_tick;
  using Solver = acoustics::RaySolver;
  for (const Solver solver : {Solver::kImages, Solver::kSnell, Solver::kArcs})
    if (p.solver == to_name(solver)) rays.solver = solver;
  if (p.shadow_loss_db > 0) rays.shadow_loss = Decibels{p.shadow_loss_db};
  rays.fading = p.fading;
  rays.reverberation = p.reverberation;
  rays.coherent = p.coherent && !p.fading.enabled;
  return rays;
}

}  // namespace halocline::channel_server
