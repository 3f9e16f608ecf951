#include "channel_server/links/link_table.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "acoustics/fading/sound_path.h"
#include "core/frames.h"

namespace halocline::channel_server {
namespace {

// The rows of all tables, sender by sender, the receivers by id.
struct Links {
  std::vector<EndPair> ends;
  std::vector<std::pair<std::size_t, std::size_t>> vehicles;  // indices of both
};

Links links_between(const std::vector<PlacedVehicle>& vehicles, Shard shard,
                    const std::vector<double>& reaches_m) {
  std::vector<Vec3> places;
  for (const PlacedVehicle& vehicle : vehicles) places.push_back(vehicle.placement.position_ned_m);
  Links links;
  for (std::size_t from = 0; from < vehicles.size(); ++from) {
    if (!shard.serves(vehicles[from].id)) continue;
    const double reach_m = reaches_m.empty() ? acoustics::kGreatestBoundedRange : reaches_m[from];
    for (std::size_t to = 0; to < vehicles.size(); ++to) {
      if (to == from || (places[to] - places[from]).squaredNorm() > reach_m * reach_m) continue;
      links.ends.push_back({link_end(vehicles[from]), link_end(vehicles[to])});
      links.vehicles.emplace_back(from, to);
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
                      Shard shard, const std::vector<double>& reaches_m) {
  return propagation.are_ready(instant, links_between(vehicles, shard, reaches_m).ends);
}

std::vector<LinkTable> link_tables(SimTime instant, const std::vector<PlacedVehicle>& vehicles,
                                   Propagation& propagation, LinkPredictor& predictor,
                                   const MultipathFunction& multipath, const ForEach& for_each, Shard shard,
                                   const std::vector<double>& reaches_m) {
  if (propagation.plans_ticks()) {
    propagation.begin_tick(instant, links_between(vehicles, {}, reaches_m).ends);
  }
  const Links links = links_between(vehicles, shard, reaches_m);
  std::vector<std::shared_ptr<const LinkPredictor::Rates>> rates;  // of each link's transmitter
  for (const EndPair& link : links.ends) rates.push_back(predictor.rates_of(*link.from.modem));
  const std::vector<Reception> receptions = propagation.receptions(instant, links.ends, for_each);
  std::vector<LinkForecast> forecasts(links.ends.size());
  for_each(links.ends.size(), [&](std::size_t i) {
    const auto& [from, to] = links.ends[i];
    forecasts[i] = predictor.forecast(*rates[i], *from.modem, *to.modem, receptions[i]);
  });
  std::vector<LinkTable> tables;
  std::size_t link = 0;
  for (std::size_t sender = 0; sender < vehicles.size(); ++sender) {
    const PlacedVehicle& from = vehicles[sender];
    if (!shard.serves(from.id)) continue;
    LinkTable table;
    table.vehicle_id = from.id;
    if (!reaches_m.empty()) table.reach_m = reaches_m[sender];
    for (; link < links.ends.size() && links.vehicles[link].first == sender; ++link) {
      const PlacedVehicle& to = vehicles[links.vehicles[link].second];
      LinkRow row;
      row.transmitter_id = from.id;
      row.receiver_id = to.id;
      row.transmitter_age = from.placement.age;
      row.receiver_age = to.placement.age;
      row.set(receptions[link], forecasts[link]);
      row.multipath = receptions[link].used == PropagationUsed::kStraight
                          ? multipath(from, to)
                          : multipath_of(receptions[link], to.modem->modem.min_receivable_level);
      table.rows.push_back(row);
    }
    table.out_of_reach = vehicles.size() - 1 - table.rows.size();
    tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace halocline::channel_server
