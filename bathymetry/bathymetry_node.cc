// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/bathymetry_node.h"

#include <algorithm>
#include <utility>

#include "bathymetry/rasters/terrain_recipe.h"
#include "bus/messages/channels.h"
#include "core/check.h"

namespace halocline::bathymetry {
namespace {

// Earlier than any time in a message: due as soon as the simulation time is known.
constexpr SimTime kOnceTimeIsKnown = SimTime::from_nanoseconds(-4'000'000'000'000'000'000);

}  // namespace

BathymetryNode::BathymetryNode(lcm::LCM& lcm, bus::NodeIdentity identity,
                               std::shared_ptr<const Terrain> terrain, std::string summary)
    : Node(lcm, std::move(identity)), terrain_(std::move(terrain)), summary_(std::move(summary)) {
  require(terrain_ != nullptr, "the bathymetry node needs a terrain");
  terrain_version_ = version_text(terrain_->version());
  bus().subscribe<ray_query_t>(bus::channels::kRayQuery, [this](const ray_query_t& query) {
    store(bus::channels::kRayQuery, query, waiting_, kMaxWaiting);
  });
  bus().subscribe<terrain_query_t>(bus::channels::kTerrainQuery, [this](const terrain_query_t& query) {
    store(bus::channels::kTerrainQuery, query, tiles_waiting_, kMaxTilesWaiting);
  });
}

template <class Message, class Query>
void BathymetryNode::store(std::string_view channel, const Message& message,
                           std::vector<Waiting<Query>>& waiting, std::size_t max_waiting) {
  QueryHeader header = header_of(message);
  const bool repeated = std::any_of(waiting.begin(), waiting.end(), [&](const Waiting<Query>& other) {
    return other.header.client_name == header.client_name && other.header.request_id == header.request_id;
  });
  if (repeated) return;
  if (waiting.size() >= max_waiting) return bus().refuse(channel, "too many queries wait");
  waiting.push_back({std::move(header), from_message(message)});
}

bus::Due BathymetryNode::on_due() const {
  bus::Due due;
  if (!has_published_overview_) due.sim = kOnceTimeIsKnown;
  // Answers do not depend on simulation time.
  if (!waiting_.empty() || !tiles_waiting_.empty()) due.sim = SimTime::at_once();
  return due;
}

void BathymetryNode::on_step(const bus::Now& now) {
  if (now.sim_known && !has_published_overview_) publish_overview(now.sim);
  answer_rays();
  answer_tiles();
}

void BathymetryNode::on_restart(const bus::Now& /*now*/) { has_published_overview_ = false; }

void BathymetryNode::publish_overview(SimTime now) {
  has_published_overview_ = true;
  const QueryHeader without_client{now.to_utime(), {}, 0};
  publisher_.publish(bus::channels::kTerrain,
                     to_message(without_client, overview(*terrain_), *terrain_, terrain_version_));
}

void BathymetryNode::answer_rays() {
  for (const auto& [header, batch] : std::exchange(waiting_, {})) {
    const RayAnswers answers = answer(*terrain_, terrain_version_, batch);
    bus().publish(bus::channels::kRayReply.of(header.client_name),
                  to_message(header, answers, terrain_version_, bus().identity().session));
  }
}

void BathymetryNode::answer_tiles() {
  for (const auto& [header, query] : std::exchange(tiles_waiting_, {})) {
    publisher_.publish(bus::channels::kTerrainReply.of(header.client_name),
                       to_message(header, answer(*terrain_, query), *terrain_, terrain_version_));
  }
}

std::string BathymetryNode::status_text() const { return summary_; }

}  // namespace halocline::bathymetry
