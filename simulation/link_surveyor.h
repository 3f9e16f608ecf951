// SPDX-License-Identifier: BSD-3-Clause
// Prediction of the reception and delivery over links of a scenario at simulation time 0, for one link or for
// many.
//
// The prediction is that of a run: propagation is the channel server's (channel_server/water_model.h), with
// measured channels and changes of the environment; noise is that of LINKS, with all vehicles at their
// starts; the forecast is that of the link tables. The terrain is read directly, while the server requests it
// from the bathymetry service.
#pragma once

#include <memory>
#include <optional>

#include "acoustics/modem/modem.h"
#include "bathymetry/terrain/terrain.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/link_table_publisher.h"
#include "channel_server/links/link_predictor.h"
#include "channel_server/packets/platform_noise.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/ray_propagation.h"
#include "channel_server/propagation/reach.h"
#include "channel_server/propagation/seabed_profile.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "channel_server/water_model.h"
#include "core/sim_time.h"
#include "core/units.h"
#include "simulation/composition.h"

namespace halocline::clients {

// Predictor of links. Not thread-safe: each thread needs its own.
class LinkSurveyor {
 public:
  struct Answer {
    channel_server::Reception reception;
    channel_server::LinkForecast forecast;
  };
  using Seabed = std::shared_ptr<const channel_server::SeabedProfile>;

  // Prepares the water and the vehicles. `sources` is the result of read_water() for the scenario.
  LinkSurveyor(const ScenarioConfig& config, std::shared_ptr<const bathymetry::Terrain> terrain,
               const channel_server::WaterSources& sources);
  LinkSurveyor(const LinkSurveyor&) = delete;
  LinkSurveyor& operator=(const LinkSurveyor&) = delete;

  bool along_rays() const { return rays_.has_value(); }
  // Predicts a link between vehicles, given by their ids, or positions.
  Answer survey(const channel_server::LinkEnd& from, const channel_server::LinkEnd& to);
  // Predicts a link between positions over the bottom profile `seabed`, without capacity. `seabed` is null
  // where it is not known; it is not used along straight paths. Links that share rays pass the same `line`;
  // null: the link has a search of its own.
  Answer survey(const channel_server::LinkEnd& from, const channel_server::LinkEnd& to, const Seabed& seabed,
                channel_server::SharedLine* line);
  // Returns the forecast of a reception, found by survey() for the same ends, in noise that is louder by
  // `more_noise_db`; negative: quieter.
  channel_server::LinkForecast forecast_in_noise(const channel_server::LinkEnd& from,
                                                 const channel_server::LinkEnd& to,
                                                 const channel_server::Reception& reception,
                                                 double more_noise_db);
  // Returns the ambient noise level over the transmitter's band at time 0, with its slow change, dB re 1 uPa.
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
  std::optional<channel_server::RayPropagation> rays_;  // in the same water; empty: straight paths
  channel_server::VehicleRegistry fleet_;
  channel_server::ReachModel reach_;
  channel_server::PlatformNoise sounds_;
  channel_server::PlatformReceiverNoise noise_;
  channel_server::LinkPredictor predictor_;
};

}  // namespace halocline::clients
