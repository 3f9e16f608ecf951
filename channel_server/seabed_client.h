// Queries the bathymetry service for what the models need of the seabed, and hands its answers to them: echo
// surveys to the multipath cache, profiles to the profile cache, and those of link queries to their service.
//
// Publishes RAY_QUERY, subscribes to RAY_REPLY of a client name that contains the server's session, so that a
// recorded reply is not taken for its own. Batches, repetitions, time-outs: links/ray_query_client.h.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "bus/runtime/node.h"
#include "channel_server/links/link_query_service.h"
#include "channel_server/links/multipath_cache.h"
#include "channel_server/links/ray_query_client.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/seabed_profile_cache.h"
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
    SeabedProfileCache& profiles;
    const Propagation& propagation;
  };
  // `bottom_points`: of an echo survey.
  SeabedClient(bus::Bus& bus, Models models, Shard shard, int bottom_points);
  SeabedClient(const SeabedClient&) = delete;
  SeabedClient& operator=(const SeabedClient&) = delete;

  // The name to which replies to a server of this session go.
  static std::string client_name(std::int64_t session);

  // True when the replies received are of another terrain than those before: what was known of that is forgotten.
  [[nodiscard]] bool take_replies();
  // Surveys that no batch has taken yet make room for those of `vehicles`, which are present at the tick.
  void begin_tick(const std::vector<PlacedVehicle>& vehicles);
  // The same for a tick that is done again: without echoes, which only link tables show.
  void begin_past_tick(const std::vector<PlacedVehicle>& vehicles);
  void publish_queries(const bus::Now& now);

  // Steady time at which take_replies() or publish_queries() has something to do.
  SimTime due() const { return replies_.empty() ? models_.rays.due() : SimTime::at_once(); }
  // Whether answers for vehicles are expected.
  bool is_waiting() const { return !surveyed_pairs_.empty() && !models_.rays.is_away(); }
  // Empty before the first reply.
  const std::string& terrain_version() const { return terrain_version_; }
  // Another run has begun.
  void clear();
  std::string status_text() const;

 private:
  void forget_terrain();
  void take_finished_surveys();
  void store(const VehiclePair& pair, RayQueryClient::Finished finished);
  void drop_waiting_surveys();
  void request_echoes(const std::vector<PlacedVehicle>& vehicles);
  void request_profiles(const std::vector<PlacedVehicle>& vehicles);
  void report_presence();

  bus::Bus& bus_;
  Models models_;
  Shard shard_;
  int bottom_points_;
  std::string client_name_;
  std::vector<ray_reply_t> replies_;
  std::map<RayQueryClient::SurveyId, VehiclePair> surveyed_pairs_;
  std::string terrain_version_;
  bool reported_away_ = false;
};

}  // namespace halocline::channel_server
