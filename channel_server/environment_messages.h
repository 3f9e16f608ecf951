// The water as ENVIRONMENT describes it, and changes of it.
#pragma once

#include <optional>
#include <string>

#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/environment.h"
#include "bus/messages.h"
#include "channel_server/propagation/environment_timeline.h"

namespace halocline::channel_server {

// What ENVIRONMENT holds beside the water.
struct WaterDescription {
  std::string propagation;                       // "straight", "rays"
  std::optional<acoustics::FluidBottom> bottom;  // with rays
  std::optional<acoustics::SurfaceModel> surface;
};

// The profile at the depths of its rows (of more than 2000, every second, third, ...); of a formula, every
// 100 m down to 5000 m.
environment_t to_message(const acoustics::Environment& environment, const WaterDescription& description,
                         SimTime from, const std::string& terrain_version);

// What is set, on top of `before`, whose formula of sound speed stays. Throws InvalidArgument when the profile is
// impossible.
EnvironmentChange to_change(const environment_change_t& message, const acoustics::Environment& before);

}  // namespace halocline::channel_server
