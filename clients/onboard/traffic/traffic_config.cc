// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/traffic/traffic_config.h"

#include <array>
#include <functional>
#include <string_view>

#include "core/check.h"

namespace halocline::clients {
namespace {

using bus::ConfigVisitor;

constexpr std::string_view kAll = "all";

// Kinds of packets by name, with the bytes that a packet has in addition to, or instead of, payload_bytes.
struct Kind {
  std::int8_t kind;
  const char* name;
  std::size_t own_bytes;
  bool has_payload;
};
constexpr std::array<Kind, 5> kKinds{{{modem_send_t::DATA, "data", 0, true},
                                      {modem_send_t::PING, "ping", 0, false},
                                      {modem_send_t::MINI_PACKET, "mini-packet", 2, false},
                                      {modem_send_t::JANUS, "janus", 5, false},
                                      {modem_send_t::JANUS_CARGO, "janus-cargo", 5, true}}};

const Kind& kind_of(std::int8_t kind) {
  const auto found =
      std::find_if(kKinds.begin(), kKinds.end(), [&](const Kind& k) { return k.kind == kind; });
  ensure(found != kKinds.end(), "traffic of a kind that only modems make");
  return *found;
}

void visit_kind(ConfigVisitor& v, VehicleTraffic& t) {
  std::string name = kind_of(t.kind).name;
  std::vector<std::string> names;
  for (const Kind& kind : kKinds) names.emplace_back(kind.name);
  v.text("kind", name, names, "kind of the packets; other kinds than data only with hops = 1");
  for (const Kind& kind : kKinds) {
    if (name == kind.name) t.kind = kind.kind;
  }
  bus::integer_as(v, "rate", t.rate, {-1, 255, "", "number of a rate of the modem; -1: its default"});
  v.boolean("ack", t.ack, "true: the destination's modem acknowledges each packet by itself");
}

void visit_hops(ConfigVisitor& v, RelayRules& relay) {
  bus::integer_as(v, "hops", relay.hops,
                  {1, RelayPacket::kMaxHops, "",
                   "transmissions of a packet on its way; above 1 it goes to all in range, with a "
                   "header of 14 bytes"});
  v.when(relay.hops > 1, "hops above 1", [&] {
    v.boolean("confirmed", relay.confirmed, "true: the destination confirms, with hops above 1");
  });
}

void visit_traffic(ConfigVisitor& v, VehicleTraffic& t) {
  double period_s = t.period.seconds(), start_s = t.start.seconds();
  v.number("period_s", period_s, {0, 1e6, "s", "time between packets, by the vehicle's clock; 0: none"});
  const auto when_it_sends = [&](const std::function<void()>& body) {
    v.when(period_s > 0, "period_s above 0", body);
  };
  when_it_sends([&] {
    v.number("start_s", start_s, {0, 1e7, "s", "time of the first packet, by the vehicle's clock"});
    v.text("destination", t.destination, {}, "name of a vehicle, or all");
    visit_kind(v, t);
    v.when(kind_of(t.kind).has_payload, "kind = \"data\" or \"janus-cargo\"", [&] {
      bus::integer_as(v, "payload_bytes", t.payload_bytes, {0, 32768, "", "bytes of each packet"});
    });
  });
  t.period = SimDuration::from_seconds(period_s);
  t.start = SimTime::from_seconds(start_s);
  v.boolean("relay", t.relay.passes_on, "true: packets of others that have transmissions left are passed on");
  when_it_sends([&] { visit_hops(v, t.relay); });
  v.when(t.relay.passes_on || t.is_relayed(), "relay = true, or hops above 1", [&] {
    bus::seconds(v, "relay_wait_s", t.relay.longest_wait,
                 {0, 3600, "s", "longest random wait before a packet is passed on"});
  });
}

void visit_vehicle(ConfigVisitor& v, VehicleTraffic& traffic) {
  v.shared_with_others();
  v.text("name", traffic.vehicle, {}, "");
  bus::integer_as(v, "id", traffic.vehicle_id, {1, 2147483647, "", ""});
  if (!v.writing()) v.boolean("has_modem", traffic.has_modem, "");
  if (!v.given("traffic")) return;
  v.when(traffic.has_modem, "has_modem = true", [&] {
    v.section("traffic", "Traffic: packets that the vehicle sends",
              [&](ConfigVisitor& section) { visit_traffic(section, traffic); });
  });
}

const VehicleTraffic* find(const TrafficConfig& config, const std::string& name) {
  const auto found = std::find_if(config.vehicles.begin(), config.vehicles.end(),
                                  [&](const VehicleTraffic& vehicle) { return vehicle.vehicle == name; });
  return found == config.vehicles.end() ? nullptr : &*found;
}

void check_destination(ConfigVisitor& v, const TrafficConfig& config, const VehicleTraffic& traffic) {
  if (!v.given("traffic") || !traffic.has_modem) return;
  v.section("traffic", "", [&](ConfigVisitor& section) {
    const bool is_ping = traffic.kind == modem_send_t::PING;
    if (traffic.is_relayed() && traffic.kind != modem_send_t::DATA)
      section.problem("kind", "allowed with hops above 1 is data");
    if (traffic.ack && (traffic.destination == kAll || traffic.is_relayed() || is_ping))
      section.problem("ack", "allowed is false, or one destination, hops = 1 and no ping");
    if (traffic.destination == kAll) {
      if (is_ping) section.problem("destination", "a ping goes to one vehicle");
      return;
    }
    if (traffic.destination == traffic.vehicle)
      section.problem("destination", "a vehicle does not send to itself; allowed is another vehicle, or all");
    else if (find(config, traffic.destination) == nullptr)
      section.problem("destination", "allowed is the name of a vehicle of the scenario, or all");
  });
}

}  // namespace

std::size_t VehicleTraffic::packet_bytes() const {
  const Kind& of = kind_of(kind);
  const std::size_t bytes = of.has_payload ? static_cast<std::size_t>(payload_bytes) : 0;
  return of.own_bytes + bytes + (is_relayed() ? RelayPacket::kHeaderBytes : 0);
}

void visit(ConfigVisitor& v, TrafficConfig& config) {
  v.list(
      "vehicle", "A vehicle", config.vehicles.size(), [&](std::size_t n) { config.vehicles.resize(n); },
      [&](ConfigVisitor& item, std::size_t i) { visit_vehicle(item, config.vehicles[i]); });
  if (v.writing()) return;
  visit(v, config.clocks);
  // The second pass checks references to vehicles, once all their names are known.
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
