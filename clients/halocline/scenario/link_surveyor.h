// SPDX-License-Identifier: BSD-3-Clause
// What arrives over links of a scenario, and what they deliver: for one link or for many, as at simulation
// time 0.
//
// The same prediction as that of the run: the propagation is the channel server's
// (channel_server/water_model.h), with measured channels and changes of the environment, the noise is that of
// LINKS, vehicles lying where they start, and the forecast is that of its tables. The terrain is asked
// directly, where the server asks the bathymetry service.
#pragma once

#include <memory>
#include <optional>

#include "acoustics/modem/modem.h"
#include "acoustics/rays/arrivals.h"
#include "bathymetry/terrain/terrain.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/link_table_publisher.h"
#include "channel_server/links/link_predictor.h"
#include "channel_server/packets/vehicle_sounds.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/ray_propagation.h"
#include "channel_server/propagation/reach.h"
#include "channel_server/propagation/seabed_profile.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "channel_server/water_model.h"
#include "clients/halocline/scenario/composition.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::clients {

// Not thread-safe: each thread has its own.
class LinkSurveyor {
 public:
  struct Answer {
    channel_server::Reception reception;
    channel_server::LinkForecast forecast;
  };
  using Seabed = std::shared_ptr<const channel_server::SeabedProfile>;

  // `sources`: read_water() of the scenario.
  LinkSurveyor(const ScenarioConfig& config, std::shared_ptr<const bathymetry::Terrain> terrain,
               const channel_server::WaterSources& sources);
  LinkSurveyor(const LinkSurveyor&) = delete;
  LinkSurveyor& operator=(const LinkSurveyor&) = delete;

  bool along_rays() const { return rays_.has_value(); }
  // Of vehicles by their ids, and of positions.
  Answer survey(const channel_server::LinkEnd& from, const channel_server::LinkEnd& to);
  // Between positions, but for the capacity and the noise of vehicles, over `seabed` from the one end to the
  // other, which is null where it is not known and not looked at along straight lines. Links that share rays
  // have one `line`; null: one by itself.
  Answer survey(const channel_server::LinkEnd& from, const channel_server::LinkEnd& to, const Seabed& seabed,
                channel_server::SharedLine* line);
  // The paths behind an answer of survey(from, to) along rays.
  acoustics::Arrivals arrivals(const channel_server::LinkEnd& from, const channel_server::LinkEnd& to);
  // Ambient, over the transmitter's band, dB re 1 uPa.
  Decibels noise_level(const acoustics::Modem& transmitter);
  channel_server::Propagation& propagation() { return *water_.propagation; }

 private:
  void place_vehicles(const ScenarioConfig& config);
  template <class IsReady>
  void wait_for_terrain(const IsReady& is_ready);
  Answer forecast(const channel_server::LinkEnd& from, const channel_server::LinkEnd& to,
                  channel_server::Reception reception);

  std::shared_ptr<const bathymetry::Terrain> terrain_;
  channel_server::ServerRules rules_;
  channel_server::WaterModel water_;
  std::optional<channel_server::RayPropagation> rays_;  // in the same water
  channel_server::VehicleRegistry fleet_;
  channel_server::ReachModel reach_;
  channel_server::VehicleSounds sounds_;
  channel_server::SoundsAtReceivers noise_;
  channel_server::LinkPredictor predictor_;
};

}  // namespace halocline::clients
