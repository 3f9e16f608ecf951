// The bathymetry service on the bus: RAY_QUERY in, RAY_REPLY.<client> out.
//
// Stateless between queries: a client that got no reply repeats its query with the same request_id. Queries wait
// until the next step, which answers all of them in the order they came; a query that a client repeats while it
// waits is answered once.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bathymetry/bathymetry_messages.h"
#include "bathymetry/ray_service.h"
#include "bathymetry/terrain/terrain.h"
#include "bus/bus.h"
#include "bus/node_identity.h"
#include "bus/runtime/node.h"

namespace halocline::bathymetry {

class BathymetryNode : public bus::Node {
 public:
  // More queries than this between two steps are refused and counted: their clients repeat them.
  static constexpr std::size_t kMaxWaiting = 1024;

  // `summary`: the terrain in one line, for STATUS.
  BathymetryNode(lcm::LCM& lcm, bus::NodeIdentity identity, std::shared_ptr<const Terrain> terrain,
                 std::string summary);

 protected:
  bus::Due on_due() const override;
  void on_step(const bus::Now& now) override;
  std::string status_text() const override;

 private:
  void on_query(const ray_query_t& query);

  struct Waiting {
    QueryHeader header;
    RayBatch batch;
  };
  std::shared_ptr<const Terrain> terrain_;
  std::string terrain_version_;
  std::string summary_;
  std::vector<Waiting> waiting_;
};

}  // namespace halocline::bathymetry
