// SPDX-License-Identifier: BSD-3-Clause
// Sections [vehicle.traffic] of a scenario file: the packets that vehicles send, their destinations and
// periods.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bus/config/config.h"
#include "bus/messages/messages.h"
#include "clients/onboard/clocks/clock_set_config.h"
#include "clients/onboard/traffic/relay.h"
#include "clients/onboard/traffic/relay_packet.h"
#include "core/names.h"
#include "core/sim_time.h"

namespace halocline::clients {

// Traffic of one vehicle. A vehicle also counts what it receives, whether it sends or not.
struct VehicleTraffic {
  std::string vehicle;
  std::int32_t vehicle_id = 0;
  SimDuration period;  // time between packets; 0: none are sent
  SimTime start;       // time of the first packet, by the vehicle's clock
  std::string destination = "all";
  std::int32_t payload_bytes = 32;  // size of DATA and of JANUS cargo; other kinds have fixed sizes
  std::int8_t kind = modem_send_t::DATA;
  std::int32_t rate = -1;  // number of a rate of the modem; -1: its own
  bool ack = false;        // the receiver's modem acknowledges
  RelayRules relay = {};   // packets with hops above 1 are relayed
  bool has_modem = true;   // without one, nothing is sent

  bool is_relayed() const { return relay.hops > 1; }
  // Returns the payload size of a packet as the modem sees it, bytes.
  std::size_t packet_bytes() const;
};

struct TrafficConfig {
  std::vector<VehicleTraffic> vehicles;  // one for each vehicle of the scenario
  ClockSetConfig clocks = {};

  // Returns true when packets may be relayed; otherwise received packets are not searched for the header of
  // relays.
  bool uses_relays() const {
    return std::any_of(vehicles.begin(), vehicles.end(), [](const VehicleTraffic& traffic) {
      return traffic.is_relayed() || traffic.relay.passes_on;
    });
  }
};

void visit(bus::ConfigVisitor& v, TrafficConfig& config);

// Returns the id of `traffic.destination`; kBroadcastId for "all". Throws InvalidArgument for a name that is
// not in the scenario.
std::int32_t destination_id(const TrafficConfig& config, const VehicleTraffic& traffic);

}  // namespace halocline::clients
