// SPDX-License-Identifier: BSD-3-Clause
// Messages of the bus to the values of the control laws, and back.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>

#include "bus/messages.h"
#include "clients/autopilot/autopilot_config.h"
#include "clients/autopilot/control_laws.h"
#include "clients/autopilot/formation.h"
#include "clients/autopilot/guidance.h"
#include "clients/autopilot/hover_laws.h"
#include "clients/autopilot/navigation/acoustic_fix.h"
#include "clients/autopilot/navigation/attitude_keeper.h"
#include "clients/autopilot/navigation/navigator.h"
#include "clients/autopilot/plan.h"
#include "clients/autopilot/seabed_ahead.h"
#include "clients/autopilot/vehicle_pilot.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::clients {

// From the state, reckoned on to `at` (core/dead_reckoning.h). The speed is the forward component over
// ground; SENSORS holds the speed through the water.
Situation to_situation(const vehicle_state_t& state, SimTime at);

// From the vehicle's own sensors alone; place and attitude by reckoning, at `time_s`.
Situation to_situation(const vehicle_sensors_t& sensors, const Navigator& navigator, double time_s);

// What compass and gyro measured afresh.
AttitudeReading to_attitude_reading(const vehicle_sensors_t& sensors);

// With the velocity over ground of a Doppler log's ping, where one is given.
NavigationSample to_navigation_sample(const vehicle_sensors_t& sensors, const AttitudeKeeper& attitude,
                                      const std::optional<vehicle_dvl_t>& ping);

// Fixes within the navigator's history; others are ignored.
void take_in(const vehicle_gps_t& fix, Navigator& navigator);
// `beacons`: places of those that are known, by id.
void take_in(const vehicle_usbl_t& bearing, const std::map<std::int32_t, Vec3>& beacons,
             const AcousticFixRules& rules, Navigator& navigator);

// A localiser's place replaces the reckoned one when it is the only one left; carried on to the latest
// sample. The reckoning goes on from there, through water that it holds to be still.
void take_in(const position_estimate_t& estimate, Navigator& navigator);

// The report that a leader broadcasts.
LeaderReport to_report(const Situation& situation);

// Where a vehicle in this situation saw the ground.
AltimeterLook to_look(const vehicle_sensors_t& sensors, const Situation& situation);

// The plan and how far it has come: `progress` is that before the first situation where it is empty. What
// exceeds a message (100 behaviours, 1200 waypoints) is left out and counted.
vehicle_plan_t to_message(const Plan& plan, const PlanProgress& progress, const PilotConfig& config);

// What the autopilot does and why; `points` of its command, empty where it gives none.
autopilot_status_t to_message(Activity activity, const PlanProgress& progress,
                              const std::optional<SetPoints>& points);

// Time and numbering are the caller's.
vehicle_command_t to_message(const ActuatorCommand& command);
vehicle_command_t to_message(const std::array<double, 4>& thruster_rpm);

}  // namespace halocline::clients
