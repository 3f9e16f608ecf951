// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/links/link_table.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "acoustics/fading/arrival.h"
#include "core/frames.h"

namespace halocline::channel_server {
Multipath multipath_of(const Reception& reception, Decibels cutoff) {
  if (!is_along_rays(reception.used)) return reception.bottom_echo;
  const bool echoes = std::any_of(reception.paths.begin(), reception.paths.end(), [&](const Arrival& path) {
    return path.bottom_bounces > 0 && path.level > cutoff;
  });
  return echoes ? Multipath::kLikely : Multipath::kUnlikely;
}

void LinkRow::set(const Reception& reception, const LinkForecast& predicted) {
  forecast = predicted;
  budget = reception.budget;
  state = reception.state;
  used = reception.used;
  path_count = static_cast<std::int32_t>(number_of_paths(reception.paths));
  diffuse_level = reception.diffuse_level;
  paths_age = reception.paths_age;
  delay_spread_s = reception.delay_spread_s;
  doppler_factor =
      reception.paths.empty() ? 1 : reception.paths[first_significant(reception.paths)].doppler_factor;
}

LinkEnd link_end(const PlacedVehicle& vehicle) {
  return {vehicle.id, vehicle.placement.position_ned_m, vehicle.placement.velocity_ned_mps,
          &vehicle.modem->modem};
}

LinkEnd receiving_end(const PlacedVehicle& vehicle, const acoustics::Modem& sender) {
  LinkEnd end = link_end(vehicle);
  end.modem = &receiving_modem(*vehicle.modem, sender);
  return end;
}

TableRows table_rows(const std::vector<PlacedVehicle>& vehicles, const std::vector<double>& ranges_m,
                     Shard shard) {
  std::vector<Vec3> places;
  for (const PlacedVehicle& vehicle : vehicles) places.push_back(vehicle.placement.position_ned_m);
  TableRows rows;
  for (std::size_t from = 0; from < vehicles.size(); ++from) {
    if (!shard.serves(vehicles[from].id)) continue;
    const double range_m = ranges_m.empty() ? acoustics::kMaxBoundedRange : ranges_m[from];
    TableRows::Transmitter transmitter{from, range_m, {}};
    for (std::size_t to = 0; to < vehicles.size(); ++to) {
      if (to == from || (places[to] - places[from]).squaredNorm() > range_m * range_m) continue;
      transmitter.receivers.push_back(to);
      rows.links.push_back(
          {link_end(vehicles[from]), receiving_end(vehicles[to], vehicles[from].modem->modem)});
    }
    rows.transmitters.push_back(std::move(transmitter));
  }
  return rows;
}

std::vector<LinkTable> link_tables(SimTime instant, const std::vector<PlacedVehicle>& vehicles,
                                   const TableRows& rows, Propagation& propagation, LinkPredictor& predictor,
                                   const ForEach& for_each, NoiseOfLinks* noise) {
  std::vector<EndPair> links = rows.links;
  for (EndPair& link : links) {
    if (noise != nullptr) noise->set(link);
  }
  std::vector<std::shared_ptr<const LinkPredictor::Rates>> rates;  // of the transmitter, for each link
  for (const TableRows::Transmitter& transmitter : rows.transmitters) {
    const auto own = predictor.rates_of(vehicles[transmitter.vehicle].modem->modem);
    rates.insert(rates.end(), transmitter.receivers.size(), own);
  }
  std::vector<SlowState> slow;
  for (const EndPair& link : links) slow.push_back(predictor.slow_state(link.from.id, link.to.id, instant));
  const std::vector<Reception> receptions = propagation.receptions(instant, links, for_each);
  std::vector<LinkForecast> forecasts(links.size());
  for_each(links.size(), [&](std::size_t i) {
    const auto& [from, to] = links[i];
    forecasts[i] = predictor.forecast(*rates[i], *from.modem, *to.modem, receptions[i], slow[i]);
  });
  std::vector<LinkTable> tables;
  std::size_t link = 0;
  for (const TableRows::Transmitter& transmitter : rows.transmitters) {
    const PlacedVehicle& from = vehicles[transmitter.vehicle];
    LinkTable table{from.id, {}, transmitter.range_m, vehicles.size() - 1 - transmitter.receivers.size()};
    for (const std::size_t receiver : transmitter.receivers) {
      const PlacedVehicle& to = vehicles[receiver];
      LinkRow row;
      row.transmitter_id = from.id;
      row.receiver_id = to.id;
      row.set(receptions[link], forecasts[link]);
      row.multipath = multipath_of(receptions[link], to.modem->modem.min_receivable_level);
      row.transmitter_age = from.placement.age;
      row.receiver_age = to.placement.age;
      table.rows.push_back(row);
      ++link;
    }
    tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace halocline::channel_server
