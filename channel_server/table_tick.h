// SPDX-License-Identifier: BSD-3-Clause
// The link tables of one tick, from the vehicles present to the publication. Vehicles, modems and links stay
// as they were at the tick, however long the tables wait for the seabed or for another server.
#pragma once

#include <map>
#include <vector>

#include "channel_server/link_table_publisher.h"
#include "channel_server/links/link_predictor.h"
#include "channel_server/links/link_table.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/reach.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/shards/shard_exchange.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/shard.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/for_each.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

class TableTick {
 public:
  // What tables are made from and published by; all must outlive the tick.
  struct Parts {
    const VehicleRegistry& vehicles;
    ReachModel& reach;
    Propagation& propagation;
    LinkPredictor& predictor;
    LinkTablePublisher& publisher;
    SeabedMap& seabed;
    ShardExchange* exchange;  // null when this server shares no searches with others
    const Shard& shard;
    ForEach for_each;
  };

  TableTick(Parts parts, SimTime tick);
  TableTick(const TableTick&) = delete;
  TableTick& operator=(const TableTick&) = delete;

  SimTime tick() const { return tick_; }
  // Publishes the tables, once. Returns false, having requested what is missing, while the seabed under the
  // links is unknown or another server has not sent its eigenrays.
  [[nodiscard]] bool publish(SimTime steady);

 private:
  // Requests the seabed, and searches for the eigenrays that other servers need; false while it is unknown.
  [[nodiscard]] bool prepare(SimTime steady);
  const std::vector<EndPair>& all_links() const {
    return links_of_all_.empty() ? rows_.links : links_of_all_;
  }

  Parts parts_;
  SimTime tick_;
  std::map<const VehicleModem*, const VehicleModem> modems_;  // copies, by their place in the registry
  std::vector<PlacedVehicle> present_;
  TableRows rows_;
  std::vector<EndPair> links_of_all_;  // links of all servers; empty when this server is alone
  bool is_examined_ = false;           // the missing tiles of the seabed are requested
  bool is_prepared_ = false;           // this server's eigenray searches are done
};

}  // namespace halocline::channel_server
