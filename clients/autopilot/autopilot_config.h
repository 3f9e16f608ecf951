// The sections [vehicle.mission] and [autopilot] of a scenario file.
#pragma once

#include <string>
#include <vector>

#include "bus/config.h"
#include "clients/autopilot/control_laws.h"
#include "clients/autopilot/guidance.h"
#include "clients/autopilot/hover_laws.h"
#include "core/sim_time.h"

namespace halocline::clients {

// What the vehicle is steered with.
enum class Steering { kFins, kThrusters };

// What one vehicle's pilot is to do. Without waypoints the vehicle is not piloted.
struct PilotConfig {
  std::string vehicle;
  std::int32_t vehicle_id = 0;
  Mission mission;
  Steering steering = Steering::kFins;
  Gains gains;             // of fins
  HoverGains hover_gains;  // of thrusters
};

struct AutopilotConfig {
  SimDuration command_period = SimDuration::from_milliseconds(100);
  SimDuration state_timeout = SimDuration::from_milliseconds(1000);
  std::string only_vehicle;           // empty: all with a mission
  std::vector<PilotConfig> vehicles;  // one for each of the scenario, piloted or not
};

void visit(bus::ConfigVisitor& v, AutopilotConfig& config);

}  // namespace halocline::clients
