// SPDX-License-Identifier: BSD-3-Clause
// Water models of an environment, without a scenario.
#pragma once

#include <memory>
#include <utility>

#include "acoustics/fading/path_fading.h"
#include "acoustics/sea/environment.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/ray_propagation.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/propagation/straight_propagation.h"
#include "channel_server/water_model.h"

namespace halocline::channel_server {

inline WaterModel straight_model(const acoustics::Environment& environment) {
  auto waters = std::make_shared<EnvironmentTimeline>(environment);
  auto seabed = std::make_shared<SeabedMap>(SeabedRule{});
  auto propagation = std::make_unique<StraightPropagation>(waters, acoustics::FadingModel{}, seabed);
  return {waters, seabed, std::move(propagation), {"straight", {}, {}}};
}

inline WaterModel ray_model(const acoustics::Environment& environment, const RayModel& rays,
                            const SeabedRule& rule) {
  auto waters = std::make_shared<EnvironmentTimeline>(environment);
  auto seabed = std::make_shared<SeabedMap>(rule);
  auto propagation = std::make_unique<RayPropagation>(waters, seabed, rays);
  return {waters, seabed, std::move(propagation), {"rays", rays.bottom, rays.surface}};
}

}  // namespace halocline::channel_server
