// SPDX-License-Identifier: BSD-3-Clause
#include "clients/halocline/scenario/link_surveyor.h"

#include <utility>

#include "channel_server/propagation/environment_timeline.h"
#include "clients/halocline/scenario/link_survey.h"

namespace halocline::clients {

using channel_server::LinkEnd;

channel_server::ServerRules rules_of(const ScenarioConfig& config) {
  channel_server::ServerRules rules = config.channel_server.rules;
  rules.medium.fading = config.channel_server.propagation.fading;
  return rules;
}

LinkSurveyor::LinkSurveyor(const ScenarioConfig& config, std::shared_ptr<const bathymetry::Terrain> terrain,
                           const acoustics::Environment& environment)
    : terrain_(std::move(terrain)),
      waters_(std::make_shared<channel_server::EnvironmentTimeline>(environment)),
      straight_(waters_, config.channel_server.propagation.fading),
      predictor_(make_predictor(rules_of(config))) {
  if (config.channel_server.propagation.model == channel_server::PropagationModel::kRays)
    rays_.emplace(waters_, std::make_shared<channel_server::SeabedMap>(config.channel_server.rules.seabed),
                  make_rays(config.channel_server));
}

channel_server::Reception LinkSurveyor::reception(const LinkEnd& from, const LinkEnd& to,
                                                  const Seabed& seabed) {
  if (rays_) return rays_->reception_over(SimTime(), from, to, seabed);
  return is_cut(*terrain_, from.position_ned_m, to.position_ned_m) ? straight_.blocked(SimTime(), from, to)
                                                                   : straight_.reception(SimTime(), from, to);
}

LinkSurveyor::Answer LinkSurveyor::forecast(const LinkEnd& from, const LinkEnd& to,
                                            channel_server::Reception reception) {
  Answer answer;
  answer.reception = std::move(reception);
  answer.forecast =
      predictor_.forecast(*predictor_.rates_of(*from.modem), *from.modem, *to.modem, answer.reception);
  return answer;
}

}  // namespace halocline::clients
