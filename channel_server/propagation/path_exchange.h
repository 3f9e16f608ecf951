// SPDX-License-Identifier: BSD-3-Clause
// Exchange of search results between the channel servers of one sea.
//
// A search is a function of its query and the sea (path_search.h), so any server may make it, and a result
// that does not arrive is computed locally. The searches of link tables, and those that packets share with
// them, are sent to the server of the link's other end.
#pragma once

#include <memory>

#include "acoustics/sea/environment.h"
#include "acoustics/sea/ray_water.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/vehicles/vehicle_id.h"

namespace halocline::channel_server {

// Query of a link between two vehicles, one of this server and one of another, and the sea in which it is
// searched.
struct SharedQuery {
  VehicleId from = 0, to = 0;
  const PathQuery& query;
  const acoustics::RayWater& water;
  const acoustics::Environment& environment;
};

class PathExchange {
 public:
  virtual ~PathExchange() = default;

  // True when one of the vehicles belongs to this server and the other to another server.
  virtual bool is_shared(VehicleId a, VehicleId b) const = 0;
  // True when this server searches for the link tables of both ends.
  virtual bool is_owner(VehicleId a, VehicleId b) const = 0;
  // Notes that a link table needs the paths between the vehicles from the server that searches for them.
  virtual void await(VehicleId a, VehicleId b) = 0;
  // Returns the received paths of a query; null when none have arrived.
  virtual std::shared_ptr<const SearchResult> received(const SharedQuery& query) = 0;
  // Sends the paths of a query to the other end's server.
  virtual void found(const SharedQuery& query, const SearchResult& paths) = 0;
};

}  // namespace halocline::channel_server
