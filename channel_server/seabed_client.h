// SPDX-License-Identifier: BSD-3-Clause
// The client of the bathymetry service: it queries what the models need of the seabed and passes on the
// answers. Tiles go to the map of the seabed, urgently because packets wait for them; echo surveys to the
// multipath cache; surveys of link queries to the link query service. Failed tiles are queried again a second
// later, or as soon as the service is available again.
//
// Publishes RAY_QUERY and subscribes to RAY_REPLY of its client name, which contains the server's session, so
// that a recorded reply is not mistaken for its own. links/ray_query_client.h describes batches, repetitions
// and time-outs.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "bus/runtime/node.h"
#include "channel_server/links/echo_plan.h"
#include "channel_server/links/link_query_service.h"
#include "channel_server/links/multipath_cache.h"
#include "channel_server/links/ray_query_client.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/vehicles/shard.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

class SeabedClient {
 public:
  // The users of the answers; all must outlive the client.
  struct Models {
    RayQueryClient& rays;
    MultipathCache& echoes;
    SeabedMap& seabed;
    const Propagation& propagation;
  };
  // `bottom_points` is the number of points of an echo survey. `shard` selects the vehicles whose surveys are
  // queried here.
  SeabedClient(bus::Bus& bus, Models models, int bottom_points, EchoRule echoes, Shard shard);
  SeabedClient(const SeabedClient&) = delete;
  SeabedClient& operator=(const SeabedClient&) = delete;

  // Returns the client name to which replies to a server of this session are addressed.
  static std::string client_name(std::int64_t session);

  // Takes the replies received; `queries` gets the surveys that it has requested. Returns true when they are
  // of another terrain than those before; everything known of the earlier terrain is then dropped.
  [[nodiscard]] bool take_replies(LinkQueryService& queries);
  // Submits the echo surveys for the tables of a tick; earlier ones that no batch has taken yet are dropped.
  // `vehicles` are those present at the tick, `links` all links between them.
  void begin_tick(const std::vector<PlacedVehicle>& vehicles, const std::vector<EndPair>& links);
  void publish_queries(const bus::Now& now, LinkQueryService& queries);
  // Asks for the version of the terrain, because another server has learned one.
  void ask_for_terrain();

  // Returns the steady time at which take_replies() or publish_queries() has something to do, or those that
  // wait for the seabed may continue.
  SimTime due() const { return has_news_ || !replies_.empty() ? SimTime::at_once() : models_.rays.due(); }
  // Returns the version of the terrain; empty before the first reply.
  const std::string& terrain_version() const { return terrain_version_; }
  // Drops all surveys, for another run.
  void clear();
  std::string status_text() const;

 private:
  void forget_terrain();
  void take_finished_surveys(LinkQueryService& queries);
  void retry_failed_tiles(SimTime steady);
  void report_presence();

  bus::Bus& bus_;
  Models models_;
  int bottom_points_;
  EchoPlan plan_;
  Shard shard_;
  std::string client_name_;
  std::vector<ray_reply_t> replies_;
  std::map<RayQueryClient::SurveyId, VehiclePair> surveyed_pairs_;
  std::set<RayQueryClient::SurveyId> surveyed_tiles_;
  SimTime next_retry_;     // steady
  bool has_news_ = false;  // the seabed has changed since the last take_replies()
  std::string terrain_version_;
  bool reported_away_ = false;
};

}  // namespace halocline::channel_server
