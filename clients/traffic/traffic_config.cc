#include "clients/traffic/traffic_config.h"

#include <algorithm>
#include <string_view>

#include "core/check.h"

namespace halocline::clients {
namespace {

using bus::ConfigVisitor;

constexpr std::string_view kAll = "all";

void visit_traffic(ConfigVisitor& v, VehicleTraffic& t) {
  double period_s = t.period.seconds(), start_s = t.start.seconds();
  v.number("period_s", period_s, {0, 1e6, "s", "simulated time between packets; 0: none are sent"});
  v.number("start_s", start_s, {0, 1e7, "s", "simulation time of the first packet"});
  t.period = SimDuration::from_seconds(period_s);
  t.start = SimTime::from_seconds(start_s);
  v.text("destination", t.destination, {}, "name of a vehicle, or all");
  bus::integer_as(v, "payload_bytes", t.payload_bytes, {0, 32768, "", "bytes of each packet"});
  v.boolean("relay", t.relay.passes_on, "pass on packets of others that have transmissions left");
  bus::integer_as(v, "hops", t.relay.hops,
                  {1, RelayPacket::kMostHops, "",
                   "transmissions of its packets on their way; above 1 they go to all in range, with a "
                   "header of 14 bytes"});
  v.boolean("confirmed", t.relay.confirmed, "with hops above 1: the destination sends a confirmation back");
  bus::seconds(v, "relay_wait_s", t.relay.longest_wait,
               {0, 3600, "s", "longest random wait before a packet is passed on"});
}

void visit_vehicle(ConfigVisitor& v, VehicleTraffic& traffic) {
  v.shared_with_others();
  v.text("name", traffic.vehicle, {}, "");
  bus::integer_as(v, "id", traffic.vehicle_id, {1, 2147483647, "", ""});
  if (!v.given("traffic")) return;
  v.section("traffic", "What the traffic program sends for this vehicle",
            [&](ConfigVisitor& section) { visit_traffic(section, traffic); });
}

const VehicleTraffic* find(const TrafficConfig& config, const std::string& name) {
  const auto found = std::find_if(config.vehicles.begin(), config.vehicles.end(),
                                  [&](const VehicleTraffic& vehicle) { return vehicle.vehicle == name; });
  return found == config.vehicles.end() ? nullptr : &*found;
}

void check_destination(ConfigVisitor& v, const TrafficConfig& config, const VehicleTraffic& traffic) {
  if (!v.given("traffic")) return;
  v.section("traffic", "", [&](ConfigVisitor& section) {
    if (traffic.destination == kAll) return;
    if (traffic.destination == traffic.vehicle)
      section.problem("destination", "a vehicle does not send to itself; allowed is another vehicle, or all");
    else if (find(config, traffic.destination) == nullptr)
      section.problem("destination", "allowed is the name of a vehicle of the scenario, or all");
  });
}

}  // namespace

void visit(ConfigVisitor& v, TrafficConfig& config) {
  v.list(
      "vehicle", "A vehicle", config.vehicles.size(), [&](std::size_t n) { config.vehicles.resize(n); },
      [&](ConfigVisitor& item, std::size_t i) { visit_vehicle(item, config.vehicles[i]); });
  if (v.writing()) return;
  // Once all names are known.
  v.list(
      "vehicle", "", config.vehicles.size(), [](std::size_t) {},
      [&](ConfigVisitor& item, std::size_t i) { check_destination(item, config, config.vehicles[i]); });
}

std::int32_t destination_id(const TrafficConfig& config, const VehicleTraffic& traffic) {
  if (traffic.destination == kAll) return kBroadcastId;
  if (const VehicleTraffic* vehicle = find(config, traffic.destination)) return vehicle->vehicle_id;
  throw InvalidArgument("vehicle " + traffic.vehicle + ": traffic.destination is '" + traffic.destination +
                        "'; allowed is the name of a vehicle of the scenario, or all");
}

}  // namespace halocline::clients
