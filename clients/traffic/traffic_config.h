// SPDX-License-Identifier: BSD-3-Clause
// The sections [vehicle.traffic] of a scenario file: who sends what to whom, and how often.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bus/config/config.h"
#include "bus/messages.h"
#include "clients/clocks/clock_set_config.h"
#include "clients/traffic/relay.h"
#include "clients/traffic/relay_packet.h"
#include "core/names.h"
#include "core/sim_time.h"

namespace halocline::clients {

// What one vehicle sends. It also counts what it receives, whether it sends or not.
struct VehicleTraffic {
  std::string vehicle;
  std::int32_t vehicle_id = 0;
  SimDuration period;  // between packets; 0: none are sent
  SimTime start;       // of the first packet, by the vehicle's clock
  std::string destination = "all";
  std::int32_t payload_bytes = 32;  // of data, and of JANUS's cargo; the other kinds have their own sizes
  std::int8_t kind = modem_send_t::DATA;
  std::int32_t rate = -1;  // number of a rate of the modem; -1: its own
  bool ack = false;        // the receiver's modem acknowledges
  RelayRules relay = {};   // with hops above 1 its packets are passed on

  bool is_relayed() const { return relay.hops > 1; }
  // Of a packet as the modem has it.
  std::size_t packet_bytes() const;
};

struct TrafficConfig {
  std::vector<VehicleTraffic> vehicles;  // one for each of the scenario
  ClockSetConfig clocks = {};

  // Whether packets may be passed on: otherwise nobody looks for the header of relays in what it receives.
  bool uses_relays() const {
    return std::any_of(vehicles.begin(), vehicles.end(), [](const VehicleTraffic& traffic) {
      return traffic.is_relayed() || traffic.relay.passes_on;
    });
  }
};

void visit(bus::ConfigVisitor& v, TrafficConfig& config);

// The id of `traffic.destination`; kBroadcastId for "all". Throws InvalidArgument for a name the scenario
// does not have.
std::int32_t destination_id(const TrafficConfig& config, const VehicleTraffic& traffic);

}  // namespace halocline::clients
