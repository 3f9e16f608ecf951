#include "channel_server/links/link_table.h"

#include <algorithm>
#include <memory>

#include "acoustics/fading/sound_path.h"

namespace halocline::channel_server {
namespace {

// Sender by sender, the receivers by id.
std::vector<EndPair> links_between(const std::vector<PlacedVehicle>& vehicles, Shard shard) {
  std::vector<EndPair> links;
  for (const PlacedVehicle& from : vehicles) {
    if (!shard.serves(from.id)) continue;
    for (const PlacedVehicle& to : vehicles) {
      if (to.id != from.id) links.push_back({link_end(from), link_end(to)});
    }
  }
  return links;
}

}  // namespace

Multipath multipath_of(const Reception& reception, Decibels cutoff) {
  if (reception.used != PropagationUsed::kRays) return Multipath::kUnknown;
  const bool echoes = std::any_of(reception.paths.begin(), reception.paths.end(), [&](const SoundPath& path) {
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

bool tables_are_ready(SimTime instant, const std::vector<PlacedVehicle>& vehicles, Propagation& propagation,
                      Shard shard) {
  return propagation.are_ready(instant, links_between(vehicles, shard));
}

std::vector<LinkTable> link_tables(SimTime instant, const std::vector<PlacedVehicle>& vehicles,
                                   Propagation& propagation, LinkPredictor& predictor,
                                   const MultipathFunction& multipath, const ForEach& for_each, Shard shard) {
  if (propagation.plans_ticks()) propagation.begin_tick(instant, links_between(vehicles, {}));
  const std::vector<EndPair> links = links_between(vehicles, shard);
  std::vector<std::shared_ptr<const LinkPredictor::Rates>> rates;  // of each link's transmitter
  for (const EndPair& link : links) rates.push_back(predictor.rates_of(*link.from.modem));
  const std::vector<Reception> receptions = propagation.receptions(instant, links, for_each);
  std::vector<LinkForecast> forecasts(links.size());
  for_each(links.size(), [&](std::size_t i) {
    forecasts[i] = predictor.forecast(*rates[i], *links[i].from.modem, *links[i].to.modem, receptions[i]);
  });
  auto reception = receptions.begin();
  auto forecast = forecasts.begin();
  std::vector<LinkTable> tables;
  for (const PlacedVehicle& from : vehicles) {
    if (!shard.serves(from.id)) continue;
    LinkTable table{from.id, {}};
    for (const PlacedVehicle& to : vehicles) {
      if (to.id == from.id) continue;
      LinkRow row;
      row.transmitter_id = from.id;
      row.receiver_id = to.id;
      row.transmitter_age = from.placement.age;
      row.receiver_age = to.placement.age;
      row.set(*reception, *forecast);
      row.multipath = reception->used == PropagationUsed::kStraight
                          ? multipath(from, to)
                          : multipath_of(*reception, to.modem->modem.min_receivable_level);
      table.rows.push_back(row);
      ++reception;
      ++forecast;
    }
    tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace halocline::channel_server
