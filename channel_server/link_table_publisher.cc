#include "channel_server/link_table_publisher.h"

#include <map>
#include <tuple>
#include <utility>

#include "bus/channels.h"
#include "channel_server/link_messages.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/units.h"

namespace halocline::channel_server {

namespace {

Hearing hearing_of(const EndPair& link, SimTime tick) {
  return {link.to, link.from.modem->band(), tick, tick};
}

}  // namespace

bool LinkTablePublisher::is_noise_ready(SimTime tick, const std::vector<EndPair>& links) {
  if (!models_.sounds.any()) return true;
  bool ready = true;  // of all of them, so that all are requested at once
  std::set<VehicleId> receivers;
  for (const EndPair& link : links) {
    if (receivers.insert(link.to.id).second) ready = models_.sounds.is_ready(hearing_of(link, tick)) && ready;
  }
  return ready;
}

void LinkTablePublisher::publish(SimTime tick, const std::vector<PlacedVehicle>& vehicles,
                                 const TableRows& rows) {
  const auto multipath = [&](const PlacedVehicle& from, const PlacedVehicle& to) {
    return models_.echoes.at_last_tick(tick, from, to, models_.propagation);
  };
  std::map<std::tuple<VehicleId, double, double>, Decibels> levels;  // by receiver and band
  const auto noise = [&](const EndPair& link) {
    const Hearing hearing = hearing_of(link, tick);
    const auto [level, is_new] = levels.try_emplace({link.to.id, hearing.band.low_hz, hearing.band.high_hz});
    if (is_new) level->second = models_.sounds.mean_level(hearing);
    return level->second;
  };
  for (const LinkTable& table :
       link_tables(tick, vehicles, rows, models_.propagation, models_.predictor, multipath, for_each_,
                   &models_.kept, models_.sounds.differ() ? NoiseFunction(noise) : NoiseFunction())) {
    const std::string channel = bus::channels::kLinks.of(models_.vehicles.name_of(table.vehicle_id));
    for (const link_table_t& message : to_messages(table, tick)) publisher_.publish(channel, message);
    links_published_ += static_cast<std::int64_t>(table.rows.size());
  }
  report_presence(vehicles);
}

void LinkTablePublisher::report_presence(const std::vector<PlacedVehicle>& vehicles) {
  std::set<std::string> present;
  for (const PlacedVehicle& vehicle : vehicles) present.insert(models_.vehicles.name_of(vehicle.id));
  for (const std::string& name : present) {
    if (!present_.contains(name)) log_.info("vehicle-present", "vehicle=" + name);
  }
  for (const std::string& name : present_) {
    if (!present.contains(name)) log_.info("vehicle-gone", "vehicle=" + name);
  }
  present_ = std::move(present);
}

}  // namespace halocline::channel_server
