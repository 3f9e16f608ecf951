// SPDX-License-Identifier: BSD-3-Clause
// Configuration of the autopilot: the sections [vehicle.mission] and [autopilot] of a scenario file.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "bus/config/config.h"
#include "clients/onboard/autopilot/control_laws.h"
#include "clients/onboard/autopilot/glide_laws.h"
#include "clients/onboard/autopilot/guidance.h"
#include "clients/onboard/autopilot/hover_laws.h"
#include "clients/onboard/autopilot/navigation/acoustic_fix.h"
#include "clients/onboard/autopilot/navigation/navigator.h"
#include "clients/onboard/autopilot/plan.h"
#include "clients/onboard/clocks/clock_set_config.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::clients {

enum class Steering { kFins, kThrusters, kBuoyancy };

// Source of the vehicle's position.
enum class NavigateBy { kState, kSensors };

// Position reports that a formation leader broadcasts by its modem.
struct Broadcast {
  SimDuration period;  // 0: no reports
  SimTime start;       // time of the first report, by the vehicle's clock
};

// Mission of one vehicle. A vehicle with neither waypoints nor behaviours is not piloted.
struct PilotConfig {
  std::string vehicle;
  std::int32_t vehicle_id = 0;
  Mission mission;
  std::vector<Behaviour> behaviours;  // replace the mission's waypoints
  NavigateBy navigate_by = NavigateBy::kState;
  NavigatorRules navigator;  // used with navigate_by = sensors
  std::string usbl_beacons;  // vehicles used as USBL beacons: names, separated by spaces
  AcousticFixRules acoustic_fix;
  Vec3 start_ned_m = Vec3::Zero();  // starting position of the vehicle
  Broadcast broadcast;
  Steering steering = Steering::kFins;
  Gains gains;             // for fins
  HoverGains hover_gains;  // for thrusters
  GlideGains glide;        // for a buoyancy engine

  bool is_piloted() const { return !mission.waypoints.empty() || !behaviours.empty(); }
};

struct AutopilotConfig {
  SimDuration command_period = SimDuration::from_milliseconds(100);
  SimDuration state_timeout = SimDuration::from_milliseconds(1000);
  std::string only_vehicle;           // name of the one vehicle to pilot; empty: all that have a mission
  std::vector<PilotConfig> vehicles;  // one entry for each vehicle of the scenario, piloted or not
  ClockSetConfig clocks = {};
};

void visit(bus::ConfigVisitor& v, AutopilotConfig& config);

// Returns the positions of a pilot's beacons by vehicle id. A beacon does not move: its position is where it
// starts. Throws InvalidArgument when a name in usbl_beacons is not that of another vehicle.
std::map<std::int32_t, Vec3> beacons_of(const AutopilotConfig& config, const PilotConfig& pilot);

// Returns the vehicle of this name if it broadcasts its position, else null.
const PilotConfig* find_leader(const AutopilotConfig& config, const std::string& name);

}  // namespace halocline::clients
