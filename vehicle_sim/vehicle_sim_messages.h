// SPDX-License-Identifier: BSD-3-Clause
// Conversions between the values of the vehicle simulator and bus messages.
//
// Session and sequence number are left at 0 here; the publisher sets them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bus/messages/messages.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "vehicle_sim/dynamics/command_schedule.h"
#include "vehicle_sim/dynamics/currents.h"
#include "vehicle_sim/faults.h"
#include "vehicle_sim/power/battery.h"
#include "vehicle_sim/sensor_station.h"
#include "vehicle_sim/sensors/doppler_log.h"
#include "vehicle_sim/sensors/sensor_settings.h"
#include "vehicle_sim/sensors/sensors.h"
#include "vehicle_sim/sensors/usbl_fix_assembler.h"

namespace halocline::vehicle_sim {

vehicle_state_t to_state_message(SimTime when, std::int32_t vehicle_id, const KinematicState& state);

TimedCommand from_message(const vehicle_command_t& message);

vehicle_sensors_t to_sensors_message(SimTime when, const SensorReading& reading);

CurrentSettings from_message(const current_change_t& message);

vehicle_dvl_t to_dvl_message(SimTime when, const DvlReading& reading, double deviation_mps);
vehicle_gps_t to_gps_message(SimTime when, const GpsFix& fix, double deviation_m);
// `echoes`: one for each of the sonar's rays.
vehicle_sonar_t to_sonar_message(SimTime when, const SonarSettings& sonar, const std::vector<Echo>& echoes);
vehicle_usbl_t to_usbl_message(const UsblFix& fix, double deviation_rad);

vehicle_battery_t to_battery_message(SimTime when, std::int32_t vehicle_id, const Battery& battery,
                                     bool has_power);

vehicle_fault_t to_fault_message(const Fault& fault, bool from_scenario);
Fault from_message(const vehicle_fault_t& message);

// Identity and arrival of a received packet, from its OUTCOME and RECEIVE, for a USBL array.
PacketKey key_of(const packet_outcome_t& outcome);
PacketKey key_of(const modem_receive_t& packet);
SoundArrival arrival_of(const packet_outcome_t& outcome);
// Returns the one-way travel time; empty where it is not known on board.
std::optional<double> travel_time_of(const modem_receive_t& packet);

// Returns a query of the first hit of each beam; 1 to 4096 beams with ranges above 0.
ray_query_t to_ray_query(SimTime when, const std::string& client, std::int64_t request_id,
                         const std::vector<EchoBeam>& beams);

// Returns one echo for each beam, in order; all unavailable when the service refused or the counts differ.
std::vector<Echo> echoes_from(const ray_reply_t& reply, std::size_t beams);

}  // namespace halocline::vehicle_sim
