// SPDX-License-Identifier: BSD-3-Clause
// Bathymetry service on the bus. It answers RAY_QUERY with RAY_REPLY.<client> and TERRAIN_QUERY with
// TERRAIN_REPLY.<client>, and publishes TERRAIN, a coarse map of the whole seabed, at the start of a run, so
// that every log contains its chart.
//
// The service keeps no state between queries: a client that gets no reply repeats its query with the same
// request_id. Queries wait until the next step, which answers all of them in the order of their arrival; a
// query that a client repeats while it waits is answered once.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bathymetry/bathymetry_messages.h"
#include "bathymetry/ray_service.h"
#include "bathymetry/terrain/terrain.h"
#include "bathymetry/tile_service.h"
#include "bus/bus.h"
#include "bus/numbered_publisher.h"
#include "bus/runtime/node.h"
#include "bus/transport/node_identity.h"
#include "core/sim_time.h"

namespace halocline::bathymetry {

class BathymetryNode : public bus::Node {
 public:
  // When more queries than this arrive between two steps, the excess is refused and counted: their clients
  // repeat them.
  static constexpr std::size_t kMaxWaiting = 1024;
  static constexpr std::size_t kMaxTilesWaiting = 64;  // limit for tile queries: 3 MB of replies

  // `summary` describes the terrain in one line, for STATUS.
  BathymetryNode(lcm::LCM& lcm, bus::NodeIdentity identity, std::shared_ptr<const Terrain> terrain,
                 std::string summary);

 protected:
  bus::Due on_due() const override;
  void on_step(const bus::Now& now) override;
  void on_restart(const bus::Now& now) override;
  std::string status_text() const override;

 private:
  template <class Query>
  struct Waiting {
    QueryHeader header;
    Query query;
  };
  // Stores a query unless it is waiting already; refuses it when `max_waiting` queries wait.
  template <class Message, class Query>
  void store(std::string_view channel, const Message& message, std::vector<Waiting<Query>>& waiting,
             std::size_t max_waiting);
  void publish_overview(SimTime now);
  void answer_rays();
  void answer_tiles();

  std::shared_ptr<const Terrain> terrain_;
  std::string terrain_version_;
  std::string summary_;
  std::vector<Waiting<RayBatch>> waiting_;
  std::vector<Waiting<TileQuery>> tiles_waiting_;
  bus::NumberedPublisher publisher_{bus()};
  bool has_published_overview_ = false;
};

}  // namespace halocline::bathymetry
