// The vehicle simulator's values as messages, and back.
//
// Session and sequence numbers are the publisher's: left at 0 here, set where a message is published.
#pragma once

#include <string>
#include <vector>

#include "bus/messages.h"
#include "core/sim_time.h"
#include "vehicle_sim/command_schedule.h"
#include "vehicle_sim/currents.h"
#include "vehicle_sim/sensors.h"

namespace halocline::vehicle_sim {

vehicle_state_t to_state_message(SimTime when, std::int32_t vehicle_id, const KinematicState& state);
KinematicState from_message(const vehicle_state_t& message);

vehicle_command_t to_command_message(const TimedCommand& command);
TimedCommand from_message(const vehicle_command_t& message);

vehicle_sensors_t to_sensors_message(SimTime when, const SensorReading& reading);
SensorReading from_message(const vehicle_sensors_t& message);

current_change_t to_current_message(SimTime from, const CurrentSettings& current);
CurrentSettings from_message(const current_change_t& message);

// One altimeter's beam.
struct AltimeterBeam {
  Vec3 origin_ned_m = Vec3::Zero();
  Vec3 direction_ned = Vec3::UnitZ();  // unit
};

struct Altitude {
  AltitudeStatus status = AltitudeStatus::kUnavailable;
  double altitude_m = 0;
};

// Asks for the first hit of each beam; 1 to 4096 beams, range above 0.
ray_query_t to_ray_query(SimTime when, const std::string& client, std::int64_t request_id,
                         const std::vector<AltimeterBeam>& beams, double range_m);

// One altitude a beam, in order; all unavailable when the service refused or the counts differ.
std::vector<Altitude> altitudes_from(const ray_reply_t& reply, std::size_t beams);

}  // namespace halocline::vehicle_sim
