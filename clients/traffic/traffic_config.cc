#include "clients/traffic/traffic_config.h"

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
}

void visit_vehicle(ConfigVisitor& v, VehicleTraffic& traffic) {
  v.shared_with_others();
  v.text("name", traffic.vehicle, {}, "");
  bus::integer_as(v, "id", traffic.vehicle_id, {1, 2147483647, "", ""});
  if (!v.given("traffic")) return;
  v.section("traffic", "What the traffic program sends for this vehicle",
            [&](ConfigVisitor& section) { visit_traffic(section, traffic); });
}

}  // namespace

void visit(ConfigVisitor& v, TrafficConfig& config) {
  v.list(
      "vehicle", "A vehicle", config.vehicles.size(), [&](std::size_t n) { config.vehicles.resize(n); },
      [&](ConfigVisitor& item, std::size_t i) { visit_vehicle(item, config.vehicles[i]); });
}

std::int32_t destination_id(const TrafficConfig& config, const VehicleTraffic& traffic) {
  if (traffic.destination == kAll) return kBroadcastId;
  for (const VehicleTraffic& vehicle : config.vehicles) {
    if (vehicle.vehicle == traffic.destination) return vehicle.vehicle_id;
  }
  throw InvalidArgument("vehicle " + traffic.vehicle + ": traffic.destination is '" + traffic.destination +
                        "'; allowed is the name of a vehicle of the scenario, or all");
}

}  // namespace halocline::clients
