// The sections [vehicle.traffic] of a scenario file: who sends what to whom, and how often.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bus/config/config.h"
#include "core/names.h"
#include "core/sim_time.h"

namespace halocline::clients {

// What one vehicle sends. It also counts what it receives, whether it sends or not.
struct VehicleTraffic {
  std::string vehicle;
  std::int32_t vehicle_id = 0;
  SimDuration period;  // between packets; 0: none are sent
  SimTime start;       // of the first packet
  std::string destination = "all";
  std::int32_t payload_bytes = 32;
};

struct TrafficConfig {
  std::vector<VehicleTraffic> vehicles;  // one for each of the scenario
};

void visit(bus::ConfigVisitor& v, TrafficConfig& config);

// The id of `traffic.destination`; kBroadcastId for "all". Throws InvalidArgument for a name the scenario does
// not have.
std::int32_t destination_id(const TrafficConfig& config, const VehicleTraffic& traffic);

}  // namespace halocline::clients
