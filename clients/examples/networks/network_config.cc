// SPDX-License-Identifier: BSD-3-Clause
#include "clients/examples/networks/network_config.h"

#include <algorithm>
#include <utility>

#include "core/check.h"
#include "core/names.h"

namespace halocline::networks {
namespace {

using bus::ConfigVisitor;

void visit_times(ConfigVisitor& v, NetworkRules& r) {
  bus::seconds(v, "packet_s", r.packet, {1e-3, 3600, "s", "aloha-ca, dacap: duration of a packet of data"});
  bus::seconds(v, "longest_travel_s", r.longest_travel,
               {1e-3, 3600, "s", "dacap: of sound to the furthest vehicle that receives it"});
  bus::seconds(v, "shortest_handshake_s", r.shortest_handshake,
               {1e-3, 3600, "s", "dacap: from the leave to send to the data, at the receiver"});
  bus::seconds(v, "tolerance_s", r.tolerance,
               {0, 3600, "s", "dacap: an interferer further by that travel time disturbs nothing"});
  bus::seconds(v, "contention_s", r.contention,
               {1e-3, 3600, "s", "t-lohi: a contention round: twice the greatest travel time and a tone"});
  v.number("sound_speed_mps", r.sound_speed_mps,
           {1000, 2000, "m/s", "aloha-ca: makes travel times of the distances at the start"});
}

void visit_rules(ConfigVisitor& v, NetworkRules& r) {
  bus::choice(v, "mac", r.mac,
              {"none", "aloha", "slotted-aloha", "tdma", "csma", "maca", "aloha-ca", "dacap", "t-lohi"},
              "medium access control; none: no network runs");
  bus::choice(v, "router", r.router, {"static", "flooding"}, "how packets find their way");
  bus::seconds(v, "interval_s", r.interval,
               {1e-3, 1e7, "s", "mean time between the packets that a vehicle offers (Poisson)"});
  bus::integer_as(v, "data_bytes", r.data_bytes, {0, 32000, "bytes", "of each packet, beside 21 of header"});
  bus::seconds(v, "slot_s", r.slot, {1e-3, 3600, "s", "slotted-aloha, tdma: length of a slot"});
  bus::seconds(v, "backoff_s", r.backoff,
               {1e-3, 3600, "s", "csma, maca, aloha-ca, dacap: mean wait before another try"});
  bus::integer_as(v, "tries", r.tries,
                  {1, 1000, "", "csma, maca, aloha-ca, dacap: before a packet is dropped"});
  v.number("carrier_threshold_db", r.carrier_threshold_db,
           {0, 100, "dB", "csma, maca, dacap, t-lohi: carrier is sensed so far above the noise"});
  bus::seconds(
      v, "handshake_s", r.handshake,
      {1e-3, 3600, "s", "maca, dacap: from a request to the end of the leave to send, at the longest"});
  bus::seconds(
      v, "exchange_s", r.exchange,
      {1e-3, 3600, "s", "maca, dacap: from the leave to send to the end of the data, at the longest"});
  visit_times(v, r);
  bus::integer_as(v, "hops", r.hops, {1, 15, "", "flooding: transmissions of a packet on its way"});
  bus::seconds(v, "relay_wait_s", r.relay_wait,
               {0, 3600, "s", "flooding: longest random wait before a packet is passed on"});
}

void visit_member(ConfigVisitor& v, NetworkMember& member) {
  v.shared_with_others();
  v.text("name", member.vehicle, {}, "");
  bus::integer_as(v, "id", member.vehicle_id, {1, 2147483647, "", ""});
  v.vector3("start_ned_m", member.start_ned_m, {-1e6, 1e6, "m", ""});
  if (!v.given("network")) return;
  v.section("network", "Its part in the example network", [&](ConfigVisitor& section) {
    section.text("destination", member.destination, {},
                 "of the packets that it offers: name of a vehicle, or all; empty: it offers none");
    section.text("via", member.via, {},
                 "static: name of the neighbour that all packets go to; empty: to their destination");
  });
}

void check_member(ConfigVisitor& v, const NetworkConfig& config, const NetworkMember& member) {
  if (!v.given("network")) return;
  v.section("network", "", [&](ConfigVisitor& section) {
    for (const auto& [key, name] : {std::pair("destination", member.destination), {"via", member.via}}) {
      if (name == member.vehicle)
        section.problem(key, "allowed is another vehicle");
      else
        bus::report_refusal(section, key, [&, &wanted = name] { id_of(config, wanted); });
    }
  });
}

}  // namespace

void visit(ConfigVisitor& v, NetworkConfig& config) {
  v.section("network", "The example network (clients/examples/networks)",
            [&](ConfigVisitor& section) { visit_rules(section, config.rules); });
  v.list(
      "vehicle", "A vehicle", config.members.size(), [&](std::size_t n) { config.members.resize(n); },
      [&](ConfigVisitor& item, std::size_t i) { visit_member(item, config.members[i]); });
  if (v.writing()) return;
  // Once all names are known.
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
