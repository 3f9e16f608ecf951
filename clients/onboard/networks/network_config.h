// SPDX-License-Identifier: BSD-3-Clause
// Sections [network] and [vehicle.network] of a scenario file: protocols and offered load of the example
// networks.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bus/config/config.h"
#include "clients/onboard/clocks/clock_set_config.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::networks {

enum class MacKind { kNone, kAloha, kSlottedAloha, kTdma, kCsma, kMaca, kAlohaCa, kDacap, kTLohi };
enum class RouterKind { kStatic, kFlooding };

struct NetworkRules {
  MacKind mac = MacKind::kNone;
  RouterKind router = RouterKind::kStatic;
  SimDuration interval = SimDuration::from_seconds(60);  // mean time between a vehicle's offered packets
  std::int32_t data_bytes = 32;
  SimDuration slot = SimDuration::from_seconds(1);                // slotted ALOHA, TDMA
  SimDuration backoff = SimDuration::from_seconds(10);            // mean; CSMA, MACA, ALOHA-CA, DACAP
  int tries = 1;                                                  // attempts; CSMA, MACA, ALOHA-CA, DACAP
  double carrier_threshold_db = 6;                                // CSMA, MACA, DACAP, T-Lohi
  SimDuration handshake = SimDuration::from_seconds(5);           // MACA, DACAP
  SimDuration exchange = SimDuration::from_seconds(10);           // MACA, DACAP
  SimDuration packet = SimDuration::from_seconds(1);              // ALOHA-CA, DACAP
  SimDuration longest_travel = SimDuration::from_seconds(1);      // DACAP
  SimDuration shortest_handshake = SimDuration::from_seconds(2);  // DACAP
  SimDuration tolerance = SimDuration::from_seconds(1.1);         // DACAP
  SimDuration contention = SimDuration::from_seconds(2.2);        // T-Lohi
  double sound_speed_mps = 1500;                                  // ALOHA-CA
  int hops = 4;                                                   // flooding
  SimDuration relay_wait = SimDuration::from_seconds(2);          // flooding
};

struct NetworkMember {
  std::string vehicle;
  std::int32_t vehicle_id = 0;
  Vec3 start_ned_m = Vec3::Zero();
  std::string destination;  // a vehicle, or "all"; empty: the vehicle offers no packets
  std::string via;          // static routing: neighbour for all packets; empty: their destination
};

struct NetworkConfig {
  NetworkRules rules;
  std::vector<NetworkMember> members;  // one for each vehicle of the scenario
  clients::ClockSetConfig clocks = {};
};

void visit(bus::ConfigVisitor& v, NetworkConfig& config);

// Returns the id of a member; kBroadcastId for "all" and "". Throws InvalidArgument for a name that is not in
// the scenario.
std::int32_t id_of(const NetworkConfig& config, const std::string& name);

}  // namespace halocline::networks
