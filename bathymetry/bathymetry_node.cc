#include "bathymetry/bathymetry_node.h"

#include <algorithm>
#include <utility>

#include "bathymetry/rasters/terrain_recipe.h"
#include "bathymetry/ray_service.h"
#include "bus/bus.h"
#include "bus/channels.h"
#include "core/check.h"
#include "core/sim_time.h"

namespace halocline::bathymetry {

BathymetryNode::BathymetryNode(lcm::LCM& lcm, bus::NodeIdentity identity,
                               std::shared_ptr<const Terrain> terrain, std::string summary)
    : Node(lcm, std::move(identity)), terrain_(std::move(terrain)), summary_(std::move(summary)) {
  require(terrain_ != nullptr, "the bathymetry node needs a terrain");
  terrain_version_ = version_text(terrain_->version());
  bus().subscribe<ray_query_t>(bus::channels::kRayQuery,
                               [this](const ray_query_t& query) { on_query(query); });
}

void BathymetryNode::on_query(const ray_query_t& query) {
  QueryHeader header = header_of(query);
  const bool repeated = std::any_of(waiting_.begin(), waiting_.end(), [&](const Waiting& other) {
    return other.header.client_name == header.client_name && other.header.request_id == header.request_id;
  });
  if (repeated) return;
  if (waiting_.size() >= kMaxWaiting) return bus().refuse(bus::channels::kRayQuery, "too many queries wait");
  waiting_.push_back({std::move(header), from_message(query)});
}

bus::Due BathymetryNode::on_due() const {
  bus::Due due;
  if (!waiting_.empty()) due.sim = SimTime::at_once();  // answers do not depend on simulation time
  return due;
}

void BathymetryNode::on_step(const bus::Now& /*now*/) {
  const std::vector<Waiting> queries = std::exchange(waiting_, {});
  for (const Waiting& query : queries) {
    const RayAnswers answers = answer(*terrain_, terrain_version_, query.batch);
    bus().publish(bus::channels::kRayReply.of(query.header.client_name),
                  to_message(query.header, answers, terrain_version_, bus().identity().session));
  }
}

std::string BathymetryNode::status_text() const { return summary_; }

}  // namespace halocline::bathymetry
