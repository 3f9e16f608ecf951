#include "channel_server/link_table.h"

namespace halocline::channel_server {

std::vector<PlacedVehicle> place_all(const Fleet& fleet, SimTime instant) {
  std::vector<PlacedVehicle> placed;
  for (const VehicleId id : fleet.present(instant)) {
    placed.push_back({id, *fleet.placement(id, instant, instant), &fleet.modem(id, instant)});
  }
  return placed;
}

std::vector<LinkTable> link_tables(const std::vector<PlacedVehicle>& vehicles, Propagation& propagation,
                                   const MultipathJudge& multipath) {
  std::vector<LinkTable> tables;
  for (const PlacedVehicle& from : vehicles) {
    LinkTable table{from.id, {}};
    for (const PlacedVehicle& to : vehicles) {
      if (to.id == from.id) continue;
      table.rows.push_back({from.id, to.id,
                            propagation.budget(from.modem->modem, to.modem->modem,
                                               from.placement.position_ned_m, to.placement.position_ned_m),
                            multipath(from, to), from.placement.age, to.placement.age});
    }
    tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace halocline::channel_server
