// SPDX-License-Identifier: BSD-3-Clause
// Conversions between bus messages and the values of the autopilot's control laws.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>

#include "bus/messages/messages.h"
#include "clients/onboard/autopilot/autopilot_config.h"
#include "clients/onboard/autopilot/control_laws.h"
#include "clients/onboard/autopilot/formation.h"
#include "clients/onboard/autopilot/guidance.h"
#include "clients/onboard/autopilot/hover_laws.h"
#include "clients/onboard/autopilot/navigation/acoustic_fix.h"
#include "clients/onboard/autopilot/navigation/attitude_keeper.h"
#include "clients/onboard/autopilot/navigation/navigator.h"
#include "clients/onboard/autopilot/plan.h"
#include "clients/onboard/autopilot/seabed_ahead.h"
#include "clients/onboard/autopilot/vehicle_pilot.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::clients {

// Returns the situation from the true state, extrapolated to `at` (core/state_extrapolation.h). The water
// speed is the forward component of the velocity over ground; the speed through the water itself is in
// SENSORS.
Situation to_situation(const vehicle_state_t& state, SimTime at);

// Returns the situation at `time_s` from the vehicle's own sensors alone; position and attitude are those of
// dead reckoning.
Situation to_situation(const vehicle_sensors_t& sensors, const Navigator& navigator, double time_s);

// Returns attitude and angular rates as far as compass and gyro measured them in this message.
AttitudeReading to_attitude_reading(const vehicle_sensors_t& sensors);

// Returns the sample for the navigator. `ping`: a Doppler log's velocity over ground; empty: none.
NavigationSample to_navigation_sample(const vehicle_sensors_t& sensors, const AttitudeKeeper& attitude,
                                      const std::optional<vehicle_dvl_t>& ping);

// Give a position fix to the navigator. A fix from before the navigator's history is ignored.
void take_in(const vehicle_gps_t& fix, Navigator& navigator);
// `beacons`: the known beacon positions by vehicle id; bearings of other vehicles are ignored.
void take_in(const vehicle_usbl_t& bearing, const std::map<std::int32_t, Vec3>& beacons,
             const AcousticFixRules& rules, Navigator& navigator);

// Replaces the dead-reckoned position by a localiser's estimate, extrapolated to the latest sample. Estimates
// that are not unique are ignored. Dead reckoning continues from there, on the assumption that the water is
// at rest.
void take_in(const position_estimate_t& estimate, Navigator& navigator);

// Returns the report that a formation leader broadcasts.
LeaderReport to_report(const Situation& situation);

// Returns the altimeter measurement with the position at which it was made.
AltimeterSample to_altimeter_sample(const vehicle_sensors_t& sensors, const Situation& situation);

// Returns the plan and its progress; before the first situation `progress` is the default one. Behaviours
// beyond 100 and waypoints beyond 1200 do not fit the message; they are left out and counted.
vehicle_plan_t to_message(const Plan& plan, const PlanProgress& progress, const PilotConfig& config);

// Returns the autopilot's activity and set points. `points`: set points of the latest command; empty: no
// command was given.
autopilot_status_t to_message(Activity activity, const PlanProgress& progress,
                              const std::optional<SetPoints>& points);

// Returns the command; the caller sets time stamp, session and sequence number.
vehicle_command_t to_message(const ActuatorCommand& command);
vehicle_command_t to_message(const std::array<double, 4>& thruster_rpm);

}  // namespace halocline::clients
