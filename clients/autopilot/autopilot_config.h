// SPDX-License-Identifier: BSD-3-Clause
// The sections [vehicle.mission] and [autopilot] of a scenario file.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "bus/config/config.h"
#include "clients/autopilot/control_laws.h"
#include "clients/autopilot/glide_laws.h"
#include "clients/autopilot/guidance.h"
#include "clients/autopilot/hover_laws.h"
#include "clients/autopilot/navigation/acoustic_fix.h"
#include "clients/autopilot/navigation/navigator.h"
#include "clients/autopilot/plan.h"
#include "clients/clocks/clock_set_config.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::clients {

// What the vehicle is steered with.
enum class Steering { kFins, kThrusters, kBuoyancy };

// Source of the vehicle's position.
enum class NavigateBy { kState, kSensors };

// Its position reports, broadcast by modem.
struct Broadcast {
  SimDuration period;  // 0: none
  SimTime start;
};

// What one vehicle's pilot is to do. Without waypoints and behaviours the vehicle is not piloted.
struct PilotConfig {
  std::string vehicle;
  std::int32_t vehicle_id = 0;
  Mission mission;
  std::vector<Behaviour> behaviours;  // instead of the mission's waypoints
  double ground_ahead_m = 4;          // how far ahead of the vehicle the ground is looked at
  NavigateBy navigate_by = NavigateBy::kState;
  NavigatorRules navigator;  // with sensors
  std::string usbl_beacons;  // names, with spaces between: by whose sound it finds its place
  AcousticFixRules acoustic_fix;
  SimDuration dvl_fresh_for = SimDuration::from_milliseconds(1500);  // age of a ping that is still used
  Vec3 start_ned_m = Vec3::Zero();                                   // where it is put into the water
  Broadcast broadcast;
  Steering steering = Steering::kFins;
  Gains gains;             // of fins
  HoverGains hover_gains;  // of thrusters
  GlideGains glide;        // by buoyancy

  bool is_piloted() const { return !mission.waypoints.empty() || !behaviours.empty(); }
};

struct AutopilotConfig {
  SimDuration command_period = SimDuration::from_milliseconds(100);
  SimDuration state_timeout = SimDuration::from_milliseconds(1000);
  std::string only_vehicle;           // empty: all with a mission
  std::vector<PilotConfig> vehicles;  // one for each of the scenario, piloted or not
  ClockSetConfig clocks = {};
};

void visit(bus::ConfigVisitor& v, AutopilotConfig& config);

// The places of a pilot's beacons by id: where they start. Throws InvalidArgument for a name that is no other
// vehicle.
std::map<std::int32_t, Vec3> beacons_of(const AutopilotConfig& config, const PilotConfig& pilot);

// The vehicle of this name if it broadcasts its place; else null.
const PilotConfig* find_leader(const AutopilotConfig& config, const std::string& name);

}  // namespace halocline::clients
