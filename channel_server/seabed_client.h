// SPDX-License-Identifier: BSD-3-Clause
// Queries the bathymetry service for what the models need of the seabed, and hands its answers to them: tiles
// to the map of the seabed, urgently, because packets wait for them; echo surveys to the multipath cache; and
// those of link queries to their service. Tiles that failed are queried again a second later, or once the
// service is back.
//
// Publishes RAY_QUERY, subscribes to RAY_REPLY of a client name that contains the server's session, so that a
// recorded reply is not taken for its own. Batches, repetitions, time-outs: links/ray_query_client.h.
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
  // Who uses the answers; all of them must outlive the client.
  struct Models {
    RayQueryClient& rays;
    LinkQueryService& queries;
    MultipathCache& echoes;
    SeabedMap& seabed;
    const Propagation& propagation;
  };
  // `bottom_points`: of an echo survey. `shard`: whose vehicles' surveys are queried here.
  SeabedClient(bus::Bus& bus, Models models, int bottom_points, EchoRule echoes, Shard shard);
  SeabedClient(const SeabedClient&) = delete;
  SeabedClient& operator=(const SeabedClient&) = delete;

  // The name to which replies to a server of this session go.
  static std::string client_name(std::int64_t session);

  // True when the replies received are of another terrain than those before: what was known of that is
  // forgotten.
  [[nodiscard]] bool take_replies();
  // Echo surveys that no batch has taken yet make room for those of the tables of a tick, at which `vehicles`
  // are present; `links`: all links between them.
  void begin_tick(const std::vector<PlacedVehicle>& vehicles, const std::vector<EndPair>& links);
  void publish_queries(const bus::Now& now);
  // Asks for the terrain's version: another server has learned one.
  void ask_for_terrain();

  // Steady time at which take_replies() or publish_queries() has something to do, or who waits for the seabed
  // may go on.
  SimTime due() const { return has_news_ || !replies_.empty() ? SimTime::at_once() : models_.rays.due(); }
  // Empty before the first reply.
  const std::string& terrain_version() const { return terrain_version_; }
  // Another run has begun.
  void clear();
  std::string status_text() const;

 private:
  void forget_terrain();
  void take_finished_surveys();
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
  bool has_news_ = false;  // of the seabed, since the last take_replies()
  std::string terrain_version_;
  bool reported_away_ = false;
};

}  // namespace halocline::channel_server
