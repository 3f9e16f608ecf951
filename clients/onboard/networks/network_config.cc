// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/networks/network_config.h"

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "core/check.h"
#include "core/names.h"

namespace halocline::networks {
namespace {

using bus::ConfigVisitor;

const std::vector<std::string> kMacs{"none", "aloha",    "slotted-aloha", "tdma",  "csma",
                                     "maca", "aloha-ca", "dacap",         "t-lohi"};
const std::vector<std::string> kRouters{"static", "flooding"};

// Visits keys that belong to some protocols only.
void with_mac(ConfigVisitor& v, const NetworkRules& r, std::initializer_list<MacKind> macs,
              const std::function<void()>& body) {
  bus::when_one_of(v, "mac", r.mac, kMacs, macs, body);
}

void with_router(ConfigVisitor& v, const NetworkRules& r, RouterKind router,
                 const std::function<void()>& body) {
  bus::when_one_of(v, "router", r.router, kRouters, {router}, body);
}

// Visits keys that have an effect only when a network runs.
void when_it_runs(ConfigVisitor& v, const NetworkRules& r, std::string_view choice,
                  const std::function<void()>& body) {
  v.when(r.mac != MacKind::kNone, choice, body);
}

void visit_times(ConfigVisitor& v, NetworkRules& r) {
  with_mac(v, r, {MacKind::kAlohaCa, MacKind::kDacap}, [&] {
    bus::seconds(v, "packet_s", r.packet, {1e-3, 3600, "s", "aloha-ca, dacap: duration of a packet of data"});
  });
  with_mac(v, r, {MacKind::kDacap}, [&] {
    bus::seconds(v, "longest_travel_s", r.longest_travel,
                 {1e-3, 3600, "s", "dacap: travel time of sound to the furthest vehicle that receives it"});
    bus::seconds(
        v, "shortest_handshake_s", r.shortest_handshake,
        {1e-3, 3600, "s", "dacap: shortest time from the clear-to-send to the data, at the receiver"});
    bus::seconds(v, "tolerance_s", r.tolerance,
                 {0, 3600, "s", "dacap: additional travel time of an interferer that disturbs nothing"});
  });
  with_mac(v, r, {MacKind::kTLohi}, [&] {
    bus::seconds(v, "contention_s", r.contention,
                 {1e-3, 3600, "s", "t-lohi: contention round: twice the greatest travel time and a tone"});
  });
}

void visit_access(ConfigVisitor& v, NetworkRules& r) {
  using Mac = MacKind;
  with_mac(v, r, {Mac::kSlottedAloha, Mac::kTdma}, [&] {
    bus::seconds(v, "slot_s", r.slot, {1e-3, 3600, "s", "slotted-aloha, tdma: length of a slot"});
  });
  with_mac(v, r, {Mac::kCsma, Mac::kMaca, Mac::kAlohaCa, Mac::kDacap}, [&] {
    bus::seconds(v, "backoff_s", r.backoff, {1e-3, 3600, "s", "csma, maca, aloha-ca, dacap: mean backoff"});
    bus::integer_as(v, "tries", r.tries, {1, 1000, "", "csma, maca, aloha-ca, dacap: tries of a packet"});
  });
}

// Visits the thresholds and times that follow from modem and distances.
void visit_tuning(ConfigVisitor& v, NetworkRules& r) {
  using Mac = MacKind;
  with_mac(v, r, {Mac::kCsma, Mac::kMaca, Mac::kDacap, Mac::kTLohi}, [&] {
    v.number("carrier_threshold_db", r.carrier_threshold_db,
             {0, 100, "dB", "csma, maca, dacap, t-lohi: level above the noise at which carrier is sensed"});
  });
  with_mac(v, r, {Mac::kMaca, Mac::kDacap}, [&] {
    bus::seconds(
        v, "handshake_s", r.handshake,
        {1e-3, 3600, "s", "maca, dacap: longest time from a request to the end of the clear-to-send"});
    bus::seconds(
        v, "exchange_s", r.exchange,
        {1e-3, 3600, "s", "maca, dacap: longest time from the clear-to-send to the end of the data"});
  });
  visit_times(v, r);
}

void visit_rules(ConfigVisitor& v, NetworkRules& r) {
  bus::choice(v, "mac", r.mac, kMacs, "medium access control; none: no network runs");
  when_it_runs(v, r, "a mac", [&] {
    bus::choice(v, "router", r.router, kRouters, "routing of packets");
    bus::seconds(v, "interval_s", r.interval,
                 {1e-3, 1e7, "s", "mean time between the packets that a vehicle offers (Poisson)"});
    bus::integer_as(v, "data_bytes", r.data_bytes,
                    {0, 32000, "bytes", "data of each packet, in addition to a header of 21 bytes"});
    visit_access(v, r);
    v.advanced([&] { visit_tuning(v, r); });
    with_router(v, r, RouterKind::kFlooding, [&] {
      bus::integer_as(v, "hops", r.hops, {1, 15, "", "flooding: transmissions of a packet on its way"});
      bus::seconds(v, "relay_wait_s", r.relay_wait,
                   {0, 3600, "s", "flooding: longest random wait before a packet is passed on"});
    });
  });
}

void visit_member(ConfigVisitor& v, const NetworkRules& rules, NetworkMember& member) {
  v.shared_with_others();
  v.text("name", member.vehicle, {}, "");
  bus::integer_as(v, "id", member.vehicle_id, {1, 2147483647, "", ""});
  v.vector3("start_ned_m", member.start_ned_m, {-1e6, 1e6, "m", ""});
  if (!v.given("network")) return;
  when_it_runs(v, rules, "a network.mac", [&] {
    v.section("network", "Part of the vehicle in the network", [&](ConfigVisitor& section) {
      section.text(
          "destination", member.destination, {},
          "destination of the packets that it offers: name of a vehicle, or all; empty: it offers none");
      section.when(rules.router == RouterKind::kStatic, "network.router = \"static\"", [&] {
        section.text("via", member.via, {},
                     "static: name of the neighbour that all packets go to; empty: to their destination");
      });
    });
  });
}

void check_member(ConfigVisitor& v, const NetworkConfig& config, const NetworkMember& member) {
  if (!v.given("network")) return;
  const auto check = [&](ConfigVisitor& section) {
    for (const auto& [key, name] : {std::pair("destination", member.destination), {"via", member.via}}) {
      if (name == member.vehicle)
        section.problem(key, "allowed is another vehicle");
      else
        bus::report_refusal(section, key, [&, &wanted = name] { id_of(config, wanted); });
    }
  };
  when_it_runs(v, config.rules, "a network.mac", [&] { v.section("network", "", check); });
}

}  // namespace

void visit(ConfigVisitor& v, NetworkConfig& config) {
  v.section("network", "Network: medium access and routing",
            [&](ConfigVisitor& section) { visit_rules(section, config.rules); });
  v.list(
      "vehicle", "A vehicle", config.members.size(), [&](std::size_t n) { config.members.resize(n); },
      [&](ConfigVisitor& item, std::size_t i) { visit_member(item, config.rules, config.members[i]); });
  if (v.writing()) return;
  visit(v, config.clocks);
  // The second pass checks references to vehicles, once all their names are known.
  v.list(
      "vehicle", "", config.members.size(), [](std::size_t) {},
      [&](ConfigVisitor& item, std::size_t i) { check_member(item, config, config.members[i]); });
}

std::int32_t id_of(const NetworkConfig& config, const std::string& name) {
  if (name.empty() || name == "all") return kBroadcastId;
  const auto found = std::find_if(config.members.begin(), config.members.end(),
                                  [&](const NetworkMember& member) { return member.vehicle == name; });
  require(found != config.members.end(),
          "there is no vehicle '" + name + "'; allowed is the name of a vehicle of the scenario");
  return found->vehicle_id;
}

}  // namespace halocline::networks
