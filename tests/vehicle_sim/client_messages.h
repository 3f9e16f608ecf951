// SPDX-License-Identifier: BSD-3-Clause
// Messages of the vehicle simulator's clients: what they publish, and what they read in its STATE.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "bus/messages/messages.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "vehicle_sim/dynamics/command_schedule.h"
#include "vehicle_sim/dynamics/currents.h"
#include "vehicle_sim/dynamics/vehicle_state.h"

namespace halocline::vehicle_sim {

inline vehicle_command_t to_command_message(const TimedCommand& command) {
  constexpr double kSecondsPerMinute = 60;
  const ActuatorValues& actuators = command.actuators;
  vehicle_command_t m{};
  m.utime = command.from.to_utime();
  m.propeller_rpm = actuators.propeller_hz * kSecondsPerMinute;
  m.rudder_rad = actuators.rudder_rad;
  m.stern_plane_rad = actuators.stern_planes_rad;
  for (std::size_t i = 0; i < actuators.thruster_hz.size(); ++i)
    m.thruster_rpm[i] = actuators.thruster_hz[i] * kSecondsPerMinute;
  m.buoyancy_m3 = actuators.buoyancy_m3;
  m.moving_mass_m = actuators.moving_mass_m;
  m.release_weight = actuators.weight == DropWeightState::kReleased ? 1 : 0;
  return m;
}

inline current_change_t to_current_message(SimTime from, const CurrentSettings& c) {
  current_change_t m{};
  m.utime = from.to_utime();
  std::copy_n(c.uniform_ned_mps.data(), 3, m.uniform_ned_mps);
  m.num_depths = static_cast<std::int32_t>(c.by_depth.size());
  for (const DepthCurrent& row : c.by_depth) {
    m.depth_m.push_back(row.depth_m);
    m.north_mps.push_back(row.north_mps);
    m.east_mps.push_back(row.east_mps);
  }
  m.tide_amplitude_mps = c.tide.amplitude_mps;
  m.tide_period_s = c.tide.period_s;
  m.tide_phase_rad = c.tide.phase_rad;
  m.tide_toward_rad = c.tide.toward_rad;
  m.random_deviation_mps = c.random.deviation_mps;
  m.random_time_s = c.random.time_s;
  return m;
}

inline KinematicState kinematics_in(const vehicle_state_t& m) {
  const double* q = m.orientation_wxyz;
  return {{Vec3(m.position_ned_m), Quaternion(q[0], q[1], q[2], q[3])},
          Vec3(m.velocity_ned_mps),
          Vec3(m.angular_velocity_body_radps)};
}

}  // namespace halocline::vehicle_sim
