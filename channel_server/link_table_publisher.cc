// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/link_table_publisher.h"

#include "acoustics/modem/modem.h"
#include "bus/messages/channels.h"
#include "channel_server/messages/link_messages.h"

namespace halocline::channel_server {

namespace {

NoiseQuery noise_query_of(const EndPair& link, SimTime at, VehicleId silent) {
  return {link.to, link.from.modem->band(), at, at, silent};
}

}  // namespace

Decibels PlatformReceiverNoise::above_ambient(const EndPair& link, SimTime at, VehicleId silent) {
  return sounds_.above_ambient(noise_query_of(link, at, silent));
}

bool PlatformReceiverNoise::is_ready(const EndPair& link, SimTime at, VehicleId silent) {
  return sounds_.is_ready(noise_query_of(link, at, silent));
}

bool LinkTablePublisher::is_noise_ready(SimTime tick, const std::vector<EndPair>& links) {
  return NoiseOfLinks(models_.noise, tick).are_ready(links);
}

void LinkTablePublisher::publish(SimTime tick, const std::vector<PlacedVehicle>& vehicles,
                                 const TableRows& rows) {
  NoiseOfLinks noise(models_.noise, tick);
  for (const LinkTable& table :
       link_tables(tick, vehicles, rows, models_.propagation, models_.predictor, for_each_, &noise)) {
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
