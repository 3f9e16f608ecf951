// SPDX-License-Identifier: BSD-3-Clause
// The client of the bathymetry service: it queries the tiles that the map of the seabed requests and stores
// the answers there. Failed tiles are queried again a second later, or as soon as the service is available
// again.
//
// Publishes RAY_QUERY and subscribes to RAY_REPLY of its client name, which contains the server's session, so
// that a recorded reply is not mistaken for its own. links/ray_query_client.h describes batches, repetitions
// and time-outs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "bus/runtime/node.h"
#include "channel_server/links/ray_query_client.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/seabed_map.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

class SeabedClient {
 public:
  // The references must outlive the client.
  SeabedClient(bus::Bus& bus, SeabedMap& seabed, const Propagation& propagation);
  SeabedClient(const SeabedClient&) = delete;
  SeabedClient& operator=(const SeabedClient&) = delete;

  // Returns the client name to which replies to a server of this session are addressed.
  static std::string client_name(std::int64_t session);

  // Takes the replies received. Returns true when they are of another terrain than those before; everything
  // known of the earlier terrain is then dropped.
  [[nodiscard]] bool take_replies();
  void publish_queries(const bus::Now& now);
  // Asks for the version of the terrain, because another server has learned one.
  void ask_for_terrain();

  // Returns the steady time at which take_replies() or publish_queries() has something to do, or those that
  // wait for the seabed may continue.
  SimTime due() const { return has_news_ || !replies_.empty() ? SimTime::at_once() : rays_.due(); }
  // Returns the version of the terrain; empty before the first reply.
  const std::string& terrain_version() const { return terrain_version_; }
  // Drops all tiles, for another run.
  void clear();
  std::string status_text() const;

 private:
  void take_finished_tiles();
  void retry_failed_tiles(SimTime steady);
  void report_presence();

  bus::Bus& bus_;
  SeabedMap& seabed_;
  const Propagation& propagation_;
  RayQueryClient rays_;
  std::string client_name_;
  std::vector<ray_reply_t> replies_;
  SimTime next_retry_;     // steady
  bool has_news_ = false;  // the seabed has changed since the last take_replies()
  std::string terrain_version_;
  bool reported_away_ = false;
};

}  // namespace halocline::channel_server
