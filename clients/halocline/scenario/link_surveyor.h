// SPDX-License-Identifier: BSD-3-Clause
// What arrives over links of a scenario, and what they deliver: for one link or for many, as at simulation time 0.
//
// Along rays, over the bottom that is given, or along the straight line, which the terrain may cut: whichever the scenario
// propagates sound by. What all links share (the water at the modem's frequency, its curves) is prepared once.
#pragma once

#include <memory>
#include <optional>

#include "acoustics/modem/modem.h"
#include "acoustics/rays/arrivals.h"
#include "acoustics/sea/environment.h"
#include "bathymetry/terrain/terrain.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/links/link_predictor.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/ray_propagation.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/propagation/seabed_profile.h"
#include "channel_server/propagation/straight_propagation.h"
#include "clients/halocline/scenario/composition.h"
#include "core/sim_time.h"

namespace halocline::clients {

// Not thread-safe: each thread has its own.
class LinkSurveyor {
 public:
  struct Answer {
    channel_server::Reception reception;
    channel_server::LinkForecast forecast;
  };
  using Seabed = std::shared_ptr<const channel_server::SeabedProfile>;

  LinkSurveyor(const ScenarioConfig& config, std::shared_ptr<const bathymetry::Terrain> terrain,
               const acoustics::Environment& environment);

  bool along_rays() const { return rays_.has_value(); }
  // `seabed` from the one end to the other; null where it is not known; not looked at along straight lines.
  Answer survey(const channel_server::LinkEnd& from, const channel_server::LinkEnd& to,
                const Seabed& seabed) {
    return forecast(from, to, reception(from, to, seabed));
  }
  // The same but for the capacity; links that share rays have one `line`, null for one by itself.
  Answer survey(const channel_server::LinkEnd& from, const channel_server::LinkEnd& to, const Seabed& seabed,
                channel_server::SharedLine* line) {
    return forecast(
        from, to,
        rays_ ? rays_->reception_over(SimTime(), from, to, seabed, line) : reception(from, to, seabed));
  }
  // The paths behind an answer along rays.
  acoustics::Arrivals arrivals(const channel_server::LinkEnd& from, const channel_server::LinkEnd& to,
                               const Seabed& seabed) {
    return rays_->arrivals_over(SimTime(), from, to, seabed);
  }
  channel_server::StraightPropagation& straight() { return straight_; }

 private:
  channel_server::Reception reception(const channel_server::LinkEnd& from, const channel_server::LinkEnd& to,
                                      const Seabed& seabed);
  Answer forecast(const channel_server::LinkEnd& from, const channel_server::LinkEnd& to,
                  channel_server::Reception reception);

  std::shared_ptr<const bathymetry::Terrain> terrain_;
  std::shared_ptr<const channel_server::EnvironmentTimeline> waters_;
  std::optional<channel_server::RayPropagation> rays_;
  channel_server::StraightPropagation straight_;
  channel_server::LinkPredictor predictor_;
};

// The server's rules with what the scenario says of fading beside them.
channel_server::ServerRules rules_of(const ScenarioConfig& config);

}  // namespace halocline::clients
