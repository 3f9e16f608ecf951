// SPDX-License-Identifier: BSD-3-Clause
// Checks that the packets of [network] fit the modems, and its times the packets and distances. Vehicles
// without a modem take no part.
#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "bus/config/config.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/packet_framing.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "clients/onboard/networks/network_config.h"
#include "clients/onboard/networks/network_packet.h"
#include "clients/onboard/traffic/relay_packet.h"
#include "core/csv_table.h"
#include "core/sim_time.h"
#include "simulation/composition.h"
#include "simulation/scenario_checks.h"

namespace halocline::clients {
namespace {

using networks::MacKind;

class NetworkChecks {
 public:
  NetworkChecks(const ScenarioConfig& config, bus::ConfigFile& file)
      : config_(config), rules_(config.network.rules), file_(file) {
    for (std::size_t i = 0; i < config.network.members.size(); ++i) {
      if (config.channel_server.vehicles.at(i).carries_modem) stations_.push_back(i);
    }
    for (const std::size_t i : stations_) {
      for (const std::size_t k : stations_) {
        const networks::NetworkMember &one = member(i), &other = member(k);
        const double distance_m = (one.start_ned_m - other.start_ned_m).norm();
        farthest_m_ = std::max(farthest_m_, distance_m);
        if (sends_to(one, other)) farthest_hop_m_ = std::max(farthest_hop_m_, distance_m);
      }
    }
  }

  void run() {
    const MacKind mac = rules_.mac;
    if (refuses_size()) return;
    if (mac == MacKind::kSlottedAloha || mac == MacKind::kTdma) check_slot();
    if (mac == MacKind::kTLohi)
      expect("contention_s", rules_.contention, longest_s(kToneBytes) + 2 * travel_s(),
             "a tone and twice the greatest travel time");
    if (mac == MacKind::kMaca || mac == MacKind::kDacap) {
      expect("handshake_s", rules_.handshake, 2 * longest_s(kMarkBytes) + 2 * hop_s(),
             "a request to send, a clear to send and twice the travel time to the farthest destination");
      expect("exchange_s", rules_.exchange, longest_s(data_bytes()) + 2 * hop_s(),
             "the data and twice the travel time to the farthest destination");
    }
    if (mac == MacKind::kAlohaCa || mac == MacKind::kDacap)
      expect("packet_s", rules_.packet, longest_s(data_bytes()), "a packet of data");
    if (mac == MacKind::kDacap)
      expect("longest_travel_s", rules_.longest_travel, hop_s(), "the way to the farthest destination");
  }

 private:
  static constexpr std::size_t kToneBytes = 4, kMarkBytes = 1;

  const networks::NetworkMember& member(std::size_t vehicle) const {
    return config_.network.members[vehicle];
  }

  channel_server::Framing framing_with(std::size_t vehicle, std::size_t bytes) const {
    channel_server::SendRequest request;
    request.payload.resize(bytes);
    return framing_of(modem_of(config_, vehicle), request);
  }

  // True for a vehicle that offers packets or passes them on.
  bool sends(std::size_t vehicle) const {
    if (!member(vehicle).destination.empty() || rules_.router == networks::RouterKind::kFlooding) return true;
    return std::any_of(stations_.begin(), stations_.end(),
                       [&](std::size_t other) { return member(other).via == member(vehicle).vehicle; });
  }

  // Refuses packets that the modem of a vehicle that sends them does not take. Returns true when it did.
  bool refuses_size() {
    const auto refuser = std::find_if(stations_.begin(), stations_.end(), [&](std::size_t i) {
      return sends(i) && framing_with(i, data_bytes()).problem != channel_server::SendResult::kAccepted;
    });
    if (refuser == stations_.end()) return false;
    file_.refuse("network.data_bytes", std::to_string(rules_.data_bytes),
                 "with their headers its packets have " + std::to_string(data_bytes()) +
                     " bytes; allowed with the modem of " + member(*refuser).vehicle + " are at most " +
                     std::to_string(largest_payload_bytes(modem_of(config_, *refuser))));
    return true;
  }

  void check_slot() {
    const double packet_s = longest_s(data_bytes());
    const bool is_shared_out = rules_.mac == MacKind::kTdma;
    expect("slot_s", rules_.slot,
           packet_s + (is_shared_out && rules_.slot.seconds() >= packet_s ? travel_s() : 0),
           rules_.slot.seconds() < packet_s ? "a packet of data" : "a packet and the greatest travel time");
  }

  // True when packets of `one` go to `other` directly.
  bool sends_to(const networks::NetworkMember& one, const networks::NetworkMember& other) const {
    const std::string& hop = one.via.empty() ? one.destination : one.via;
    if (hop == "all" || rules_.router == networks::RouterKind::kFlooding) return !hop.empty();
    return hop == other.vehicle;
  }

  // Returns the size of a data packet as the MAC sends it, with all headers.
  std::size_t data_bytes() const {
    const bool is_marked =
        rules_.mac == MacKind::kMaca || rules_.mac == MacKind::kDacap || rules_.mac == MacKind::kTLohi;
    const bool is_relayed = rules_.router == networks::RouterKind::kFlooding;
    return static_cast<std::size_t>(rules_.data_bytes) + networks::NetworkPacket::kHeaderBytes +
           (is_marked ? kMarkBytes : 0) + (is_relayed ? RelayPacket::kHeaderBytes : 0);
  }

  // Returns the duration of a packet of `bytes` bytes with the slowest modem that accepts it.
  double longest_s(std::size_t bytes) const {
    double longest_s = 0;
    for (const std::size_t i : stations_) {
      const channel_server::Framing framing = framing_with(i, bytes);
      if (framing.problem == channel_server::SendResult::kAccepted)
        longest_s = std::max(longest_s, framing.timing.duration.seconds());
    }
    return longest_s;
  }
  double travel_s() const { return farthest_m_ / rules_.sound_speed_mps; }
  double hop_s() const { return farthest_hop_m_ / rules_.sound_speed_mps; }

  void expect(const std::string& key, SimDuration given, double least_s, const std::string& what) {
    if (given.seconds() >= least_s) return;
    file_.warn("network." + key, format_number(given.seconds()),
               what + " may last " + format_number(rounded_up(least_s)) +
                   " s with these modems and places: packets collide, or expire too early");
  }

  const ScenarioConfig& config_;
  const networks::NetworkRules& rules_;
  bus::ConfigFile& file_;
  std::vector<std::size_t> stations_;  // vehicles with a modem
  double farthest_m_ = 0, farthest_hop_m_ = 0;
};

}  // namespace

void check_network(const ScenarioConfig& config, bus::ConfigFile& file) {
  if (config.network.rules.mac != MacKind::kNone) NetworkChecks(config, file).run();
}

}  // namespace halocline::clients
