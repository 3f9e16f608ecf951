// SPDX-License-Identifier: BSD-3-Clause
// The water of a channel server and how sound propagates in it.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "bus/config/scenario.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/messages/world_messages.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/measured_propagation.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/propagation/surface_ends.h"

namespace halocline::channel_server {

// The parts of the water. The propagation reads the waters and the map of the seabed, which the node keeps up
// to date.
struct WaterModel {
  std::shared_ptr<EnvironmentTimeline> waters;
  std::shared_ptr<SeabedMap> seabed;
  std::unique_ptr<Propagation> propagation;
  WaterDescription description;  // contents of ENVIRONMENT
};
// The sources from which water models of a scenario are made, read once from its files.
struct WaterSources {
  EnvironmentTimeline timeline;  // includes the scenario's changes
  MeasuredLinks measured;
  std::optional<SurfaceEnds> surface_ends = {};
};

// Adds the scenario's changes to the timeline. Throws InvalidArgument when a change is impossible.
void schedule_changes(const ChannelServerConfig& config, const bus::Scenario& scenario,
                      EnvironmentTimeline& timeline);

// Reads the water that a scenario describes. Throws InvalidArgument when it is impossible.
WaterSources read_water(const ChannelServerConfig& config, const bus::Scenario& scenario);
// Returns the ray model of a scenario, with its ends near the surface.
RayModel rays_of(const ChannelServerConfig& config, const WaterSources& sources);
// Make the water model of a scenario. Servers, surveys of links and waveforms all use these functions, so
// their propagation is the same.
WaterModel make_water_model(const ChannelServerConfig& config, const WaterSources& sources);
WaterModel make_water_model(const ChannelServerConfig& config, const bus::Scenario& scenario);

}  // namespace halocline::channel_server
