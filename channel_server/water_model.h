// SPDX-License-Identifier: BSD-3-Clause
// The water of a channel server and how sound propagates in it.
#pragma once

#include <memory>
#include <string>

#include "acoustics/fading/path_fading.h"
#include "acoustics/sea/environment.h"
#include "bus/runtime/scenario.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/measured_propagation.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/ray_propagation.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/world_messages.h"

namespace halocline::channel_server {

// The propagation reads the waters and the map of the seabed, which the node keeps up to date.
struct WaterModel {
  std::shared_ptr<EnvironmentTimeline> waters;
  std::shared_ptr<SeabedMap> seabed;
  std::unique_ptr<Propagation> propagation;
  WaterDescription description;  // for ENVIRONMENT
};
// What water models of a scenario are made of, read from its files once.
struct WaterSources {
  EnvironmentTimeline timeline;  // with the scenario's changes
  MeasuredLinks measured;
};

WaterModel straight_model(const acoustics::Environment& environment,
                          const acoustics::FadingModel& fading = {});
WaterModel ray_model(const acoustics::Environment& environment, const RayModel& rays, const SeabedRule& rule);

// Adds the scenario's changes to the timeline. Throws InvalidArgument when one cannot be.
void schedule_changes(const ChannelServerConfig& config, const bus::Scenario& scenario,
                      EnvironmentTimeline& timeline);

// As a scenario describes it. Throws InvalidArgument when that is impossible.
WaterSources read_water(const ChannelServerConfig& config, const bus::Scenario& scenario);
// The one way from a scenario to its propagation: of the server, of surveys of links, of waveforms.
WaterModel make_water_model(const ChannelServerConfig& config, const WaterSources& sources);
WaterModel make_water_model(const ChannelServerConfig& config, const bus::Scenario& scenario);

}  // namespace halocline::channel_server
