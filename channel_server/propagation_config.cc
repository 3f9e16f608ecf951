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
#include "acoustics/prediction/platform_jitter.h"
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

const std::vector<std::string> kPropagationModels{"rays", "straight"};
const std::vector<std::string> kScattering{"none", "lambert"};  // values of reverberation
constexpr std::string_view kCustom = "custom";

std::vector<std::string> sediments() {
  std::vector<std::string> names{std::string(kCustom)};
  for (const std::string_view name : acoustics::sediment_names()) names.emplace_back(name);
  return names;
}

void visit_bottom(bus::ConfigVisitor& v, PropagationConfig& p) {
  v.text("sediment", p.sediment, sediments(),
         "sediment of the bottom, by its name in APL-UW TR 9407, or custom by the numbers below");
  v.when(p.sediment == kCustom, "sediment = \"custom\"", [&] {
    v.number("bottom_density_ratio", p.bottom_density_ratio,
             {0.5, 10, "", "density of a custom sediment over the water's"});
    v.number("bottom_sound_speed_mps", p.bottom_sound_speed_mps,
             {500, 7000, "m/s", "sound speed of a custom sediment"});
    v.number("bottom_attenuation_db_per_wavelength", p.bottom_attenuation_db,
             {0, 54, "dB", "attenuation of a custom sediment"});
  });
}

// Visits keys that the straight path ignores.
void with_rays(bus::ConfigVisitor& v, const PropagationConfig& p, const std::function<void()>& body) {
  bus::when_one_of(v, "model", p.model, kPropagationModels, {PropagationModel::kRays}, body);
}

void visit_way_of_adding(bus::ConfigVisitor& v, PropagationConfig& p) {
  enum class Adding { kPowers, kFadingPaths, kPhasors };
  Adding adding = p.fading.enabled  ? Adding::kFadingPaths
                  : p.rays.coherent ? Adding::kPhasors
                                    : Adding::kPowers;
  bus::choice(v, "fading", adding, {"none", "sea", "coherent"},
              "fading of paths by waves, rough bottom and medium (docs/packets.md); without it their powers "
              "add (none) or their phasors at the centre frequency (coherent)");
  p.fading.enabled = adding == Adding::kFadingPaths;
  p.rays.coherent = adding == Adding::kPhasors;
}

void visit_slow_fading(bus::ConfigVisitor& v, acoustics::SlowFading& f) {
  v.number("slow_fading_db", f.deviation_db,
           {0, 20, "dB", "standard deviation of a link's level over hours; 0: none"});
  v.when(f.deviation_db > 0, "slow_fading_db above 0", [&] {
    v.number("slow_fading_s", f.time_s, {0.1, 1e6, "s", "correlation time of a link's level over hours"});
  });
  v.number("tidal_fading_db", f.tidal_db,
           {0, 20, "dB", "amplitude of a link's level over the lunar tide of 12.42 h; 0: none"});
  v.number("daily_fading_db", f.daily_db, {0, 20, "dB", "amplitude of a link's level over the day; 0: none"});
}

// The irregularity of the water that turns rays.
void visit_fine_structure(bus::ConfigVisitor& v, acoustics::FineStructure& f) {
  v.number(
      "fine_structure_mps", f.speed_mps,
      {0, 5, "m/s", "rms sound speed of the water's fine structure, which blurs focused sound; 0: none"});
  v.number("internal_wave_m", f.internal_wave_m,
           {0, 50, "m", "rms height of internal waves, which blur focused sound by the profile; 0: none"});
}

void visit_fading(bus::ConfigVisitor& v, PropagationConfig& p) {
  acoustics::FadingModel& f = p.fading;
  visit_way_of_adding(v, p);
  v.when(f.enabled, "fading = \"sea\"", [&] {
    v.number("large_scale_fading_db", f.large_scale_db,
             {0, 20, "dB", "standard deviation of a link's level over minutes; 0: none"});
    v.when(f.large_scale_db > 0, "large_scale_fading_db above 0", [&] {
      v.number("large_scale_fading_s", f.large_scale_time_s,
               {0.1, 1e6, "s", "correlation time of a link's level"});
    });
    visit_slow_fading(v, f.slow);
    with_rays(v, p, [&] {
      v.number("bottom_roughness_m", f.bottom_roughness_m, {0, 1, "m", "rms height of the rough bottom"});
      bus::choice(v, "scattering", f.turns, {"none", "turns"},
                  "scattered sound: none leaves it on its path, turns sends it on at new angles "
                  "(docs/packets.md)");
      v.when(f.turns, "scattering = \"turns\"", [&] {
        v.number("bottom_slope", f.bottom_slope,
                 {0.01, 1, "", "rms slope of the rough bottom's facets, which turn what it scatters"});
      });
      visit_fine_structure(v, p.rays.options.fine_structure);
    });
  });
  with_rays(v, p, [&] {
    bus::choice(v, "reverberation", p.rays.reverberation.enabled, kScattering,
                "tail that rough boundaries leave behind every packet (docs/scenarios.md)");
  });
  if (p.rays.reverberation.enabled && !f.enabled)
    v.problem("reverberation", "\"lambert\" needs fading = \"sea\"");
}

}  // namespace

void visit_propagation(bus::ConfigVisitor& v, PropagationConfig& p) {
  bus::choice(v, "model", p.model, kPropagationModels,
              "eigenrays where the bottom is known, or one straight path");
  with_rays(v, p, [&] { visit_bottom(v, p); });
  with_rays(v, p, [&] {
    enum class Beyond { kHold, kNone };
    Beyond beyond = p.rays.holds_terrain ? Beyond::kHold : Beyond::kNone;
    bus::choice(v, "beyond", beyond, {"hold", "none"},
                "seabed beyond a raster and where it has no data: its last depth, or none, and packets there "
                "are NO_TERRAIN");
    p.rays.holds_terrain = beyond == Beyond::kHold;
  });
  visit_fading(v, p);
  visit_replay(v, p.replay);
}

RayModel standard_rays() {
  RayModel rays;
  rays.bounces_follow_range = true;
  rays.options.max_bounces = 0;
  rays.options.min_amplitude = elementary::exp10(-160.0 / 20);       // of spreading and bounces, re 1 m
  rays.options.min_boundary_factor = elementary::exp10(-30.0 / 20);  // of bounces, re the strongest path
  rays.options.diffuse_below_flux_db = kExactLevel.diffuse_below_flux_db;
  rays.options.fine_structure = {.speed_mps = 0.05, .internal_wave_m = 0.5};  // chosen values
  rays.options.platform_jitter_m = acoustics::kPlatformJitterM;
  rays.diffuse_below_noise = kExactLevel.diffuse_below_noise;
  rays.weak_below_diffuse = kExactLevel.weak_below_diffuse;
  rays.speed_tolerance_mps = 0.02;
  rays.reuse_distance_m = 25;
  rays.shadow_loss = Decibels{120};  // a chosen value
  rays.near_surface.emplace();       // its ends are those of the scenario
  return rays;
}

RayModel make_rays(const ChannelServerConfig& config) {
  const PropagationConfig& p = config.propagation;
  const auto named = acoustics::sediment(p.sediment);
  require(named || p.sediment == kCustom, "no sediment is called " + p.sediment);
  RayModel rays = p.rays;
  rays.bottom = named ? *named
                      : acoustics::fluid_bottom(p.bottom_density_ratio, p.bottom_sound_speed_mps,
                                                p.bottom_attenuation_db);
  rays.fading = fading_of(config);
  rays.fading.platform_jitter_m = acoustics::kPlatformJitterM;
  // A sea that does not fade is a still one.
  if (!p.fading.enabled) rays.options.fine_structure = {};
  return rays;
}

// Below fast ice the level of links between ends at rest lives for hours.
acoustics::FadingModel fading_of(const ChannelServerConfig& config) {
  acoustics::FadingModel fading = config.propagation.fading;
  if (config.environment.ice.kind == acoustics::IceKind::kFast)
    fading.large_scale_still_s = acoustics::kIceCoherenceS;
  return fading;
}

std::optional<SurfaceEnds> make_surface_ends(const ChannelServerConfig& config,
                                             const bus::Scenario& scenario) {
  const PropagationConfig& p = config.propagation;
  const bool is_rough = p.model == PropagationModel::kRays && p.fading.enabled && p.fading.turns;
  if (!p.rays.near_surface || !is_rough) return std::nullopt;
  SurfaceEnds ends{.seed = scenario.seed};
  for (const bus::VehicleEntry& vehicle : scenario.vehicles) {
    const bool is_floating = vehicle.mount == bus::Mount::kFloating;
    if (is_floating) ends.floating.insert(vehicle.id);
    const bool lies_still = vehicle.model == "fixed" || vehicle.model == "lander";
    if (is_floating || !lies_still) ends.heaving.insert(vehicle.id);
  }
  return ends;
}

}  // namespace halocline::channel_server
