// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/water_model.h"

#include <utility>

#include "acoustics/fading/path_fading.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/sound_speed.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/ray_propagation.h"
#include "channel_server/propagation/straight_propagation.h"
#include "channel_server/replay_config.h"
#include "core/check.h"
#include "core/sim_time.h"
#include "core/units.h"
#include "ocean/ocean_field_reader.h"

namespace halocline::channel_server {

// Spans of time in each of which sound propagates through the ocean's field as it is in the span's middle.
constexpr double kSoundPeriodS = 600;

void schedule_changes(const ChannelServerConfig& config, const bus::Scenario& scenario,
                      EnvironmentTimeline& timeline) {
  for (const ChangeConfig& c : config.changes) {
    EnvironmentChange change{c.wind_mps, c.shipping, c.sea_surface_z_m, {}, c.rain_mm_per_h};
    if (c.profile) {
      EnvironmentConfig water = config.environment;
      water.profile = *c.profile;
      change.profile = make_profile(water, scenario);
    }
    timeline.schedule(SimTime::from_seconds(c.at_s), change);
  }
  for (const auto& [from, spectrum] : noise_table(config.environment)) {
    EnvironmentChange change;
    change.noise_table = spectrum;
    timeline.schedule(from, change);
  }
}

void set_field(const bus::Scenario& scenario, acoustics::Environment& environment) {
  const bus::OceanEntry& entry = scenario.ocean;
  if (entry.file.empty() || !entry.carries_sound) return;
  auto field = ocean::read_ocean_field(
      {entry.file.place(),
       entry.start_date,
       {to_radians(scenario.origin_latitude_deg), to_radians(scenario.origin_longitude_deg)}});
  if (!field->has_water()) return;
  require(environment.profile.model() != acoustics::SoundSpeedModel::kTeos10,
          "ocean fields hold no absolute salinity: teos10 cannot use them");
  environment.field = {std::move(field), kSoundPeriodS / 2, kSoundPeriodS};
  environment.profile = environment_at(environment, 0, 0).profile;
}

namespace {

WaterModel straight_in(std::shared_ptr<EnvironmentTimeline> waters, const acoustics::FadingModel& fading) {
  auto seabed = std::make_shared<SeabedMap>(SeabedRule{});
  auto propagation = std::make_unique<StraightPropagation>(waters, fading, seabed);
  return {waters, seabed, std::move(propagation), {"straight", {}, {}}};
}

WaterModel rays_in(std::shared_ptr<EnvironmentTimeline> waters, const RayModel& rays,
                   const SeabedRule& rule) {
  auto seabed = std::make_shared<SeabedMap>(rule);
  auto propagation = std::make_unique<RayPropagation>(waters, seabed, rays);
  return {waters, seabed, std::move(propagation), {"rays", rays.bottom, rays.surface}};
}

}  // namespace

WaterSources read_water(const ChannelServerConfig& config, const bus::Scenario& scenario) {
  WaterSources sources{EnvironmentTimeline(make_environment(config.environment, scenario)),
                       {},
                       make_surface_ends(config, scenario)};
  const ReplayConfig& replay = config.propagation.replay;
  if (replay.is_wanted()) sources.measured = make_measured_links(replay, make_modems(config), scenario);
  schedule_changes(config, scenario, sources.timeline);
  return sources;
}

RayModel rays_of(const ChannelServerConfig& config, const WaterSources& sources) {
  RayModel rays = make_rays(config);
  rays.near_surface = sources.surface_ends;
  return rays;
}

WaterModel make_water_model(const ChannelServerConfig& config, const WaterSources& sources) {
  auto waters = std::make_shared<EnvironmentTimeline>(sources.timeline);
  WaterModel water = config.propagation.model == PropagationModel::kRays
                         ? rays_in(std::move(waters), rays_of(config, sources), config.rules.seabed)
                         : straight_in(std::move(waters), fading_of(config));
  if (config.propagation.replay.is_wanted()) {
    water.propagation =
        std::make_unique<MeasuredPropagation>(std::move(water.propagation), water.waters, sources.measured);
  }
  return water;
}

WaterModel make_water_model(const ChannelServerConfig& config, const bus::Scenario& scenario) {
  return make_water_model(config, read_water(config, scenario));
}

}  // namespace halocline::channel_server
