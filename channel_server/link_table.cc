#include "channel_server/link_table.h"

namespace halocline::channel_server {

LinkEnd link_end(const PlacedVehicle& vehicle) {
  return {vehicle.id, vehicle.placement.position_ned_m, vehicle.placement.velocity_ned_mps,
          &vehicle.modem->modem};
}

std::vector<PlacedVehicle> place_all(const Fleet& fleet, SimTime instant) {
  std::vector<PlacedVehicle> placed;
  for (const VehicleId id : fleet.present(instant)) {
    placed.push_back({id, *fleet.placement(id, instant, instant), &fleet.modem(id, instant)});
  }
  return placed;
}

std::vector<LinkTable> link_tables(SimTime instant, const std::vector<PlacedVehicle>& vehicles,
                                   Propagation& propagation, const MultipathJudge& multipath) {
  std::vector<LinkTable> tables;
  for (const PlacedVehicle& from : vehicles) {
    LinkTable table{from.id, {}};
    for (const PlacedVehicle& to : vehicles) {
      if (to.id == from.id) continue;
      table.rows.push_back({from.id, to.id,
                            propagation.reception(instant, link_end(from), link_end(to)).budget,
                            multipath(from, to), from.placement.age, to.placement.age});
    }
    tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace halocline::channel_server
