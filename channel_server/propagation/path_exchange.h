// SPDX-License-Identifier: BSD-3-Clause
// What several channel servers of one water tell each other about the paths of sound that they searched for.
//
// A search is a function of its query and the sea (path_search.h), so it does not matter who makes it, and an
// answer that does not come is computed. The searches of link tables, and those that packets share with them,
// are told to the server of the link's other end.
#pragma once

#include <memory>

#include "acoustics/sea/environment.h"
#include "acoustics/sea/ray_water.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/vehicles/vehicle_id.h"

namespace halocline::channel_server {

// A query of the link between two vehicles that are served by this server and another, and the sea of its
// answer.
struct SharedQuery {
  VehicleId from = 0, to = 0;
  const PathQuery& query;
  const acoustics::RayWater& water;
  const acoustics::Environment& environment;
};

class PathExchange {
 public:
  virtual ~PathExchange() = default;

  // Whether the one of them is served by this server, the other by another.
  virtual bool is_shared(VehicleId a, VehicleId b) const = 0;
  // Whether this server searches for the link tables of both.
  virtual bool is_owner(VehicleId a, VehicleId b) const = 0;
  // The paths between them, of a table, are to come from the owner.
  virtual void await(VehicleId a, VehicleId b) = 0;
  // Null where none came.
  virtual std::shared_ptr<const FoundPaths> received(const SharedQuery& query) = 0;
  // To be told to the other.
  virtual void found(const SharedQuery& query, const FoundPaths& paths) = 0;
};

}  // namespace halocline::channel_server
