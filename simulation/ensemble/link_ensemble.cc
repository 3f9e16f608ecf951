// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/ensemble/link_ensemble.h"

#include <vector>

#include "channel_server/propagation/propagation.h"
#include "channel_server/water_model.h"
#include "core/check.h"
#include "core/frames.h"
#include "simulation/link_surveyor.h"

namespace halocline::clients {

LinkBands link_bands(const ScenarioConfig& config, const LinkSurveyEnd& from, const LinkSurveyEnd& to,
                     std::size_t members) {
  require(members >= 1 && members <= kMostMembers, "allowed are ensembles of 1 to 1000 members");
  const auto terrain = make_terrain(config).terrain;
  require_above_seabed(*terrain, from);
  require_above_seabed(*terrain, to);
  const double depth_m = water_depth_m(config, *terrain, from.position_ned_m, to.position_ned_m);
  const channel_server::EndPair link = ends_between(from, to);
  std::vector<double> levels_db, snrs_db, deliveries;
  for (std::size_t i = 0; i < members; ++i) {
    const MemberDraws draws = draws_of(config.scenario.seed, i, members);
    const ScenarioConfig member = member_of(config, draws, depth_m, from.modem.modem.centre_frequency_hz);
    LinkSurveyor surveyor(member, terrain, read_water(member.channel_server, member.scenario));
    const auto [reception, forecast] = surveyor.survey(link.from, link.to);
    levels_db.push_back(reception.budget.received_level.value);
    snrs_db.push_back(reception.budget.snr.value);
    deliveries.push_back(forecast.delivery_probability);
  }
  return {members, band_of(levels_db), band_of(snrs_db), band_of(deliveries)};
}

}  // namespace halocline::clients
