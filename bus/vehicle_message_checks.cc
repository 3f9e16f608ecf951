// Checks of what vehicles, their pilots and their sensors say.
#include <algorithm>
#include <array>
#include <functional>

#include "bus/message_checker.h"
#include "bus/message_checks.h"

namespace halocline::bus {
namespace {

constexpr std::int32_t kMaxFanRays = 512;

}  // namespace

std::string problem_in(const vehicle_state_t& m) {
  double square = 0;
  for (const double q : m.orientation_wxyz) square += q * q;
  return Checker()
      .utime(m.utime)
      .id("vehicle_id", m.vehicle_id)
      .all_within("position_ned_m", m.position_ned_m, -kFarthestM, kFarthestM)
      .within("|orientation_wxyz|", std::sqrt(square), 1 - kQuaternionTolerance, 1 + kQuaternionTolerance)
      .all_within("velocity_ned_mps", m.velocity_ned_mps, -kFastestMps, kFastestMps)
      .all_within("angular_velocity_body_radps", m.angular_velocity_body_radps, -kFastestTurnRadps,
                  kFastestTurnRadps)
      .result();
}

std::string problem_in(const vehicle_command_t& m) {
  return Checker()
      .utime(m.utime)
      .within("propeller_rpm", m.propeller_rpm, -1e5, 1e5)
      .within("rudder_rad", m.rudder_rad, -kPi, kPi)
      .within("stern_plane_rad", m.stern_plane_rad, -kPi, kPi)
      .all_within("thruster_rpm", m.thruster_rpm, -1e5, 1e5)
      .result();
}

std::string problem_in(const current_change_t& m) {
  constexpr double kFastestCurrentMps = 10;
  constexpr std::int32_t kMaxDepths = 1000;
  return Checker()
      .utime(m.utime)
      .all_within("uniform_ned_mps", m.uniform_ned_mps, -kFastestCurrentMps, kFastestCurrentMps)
      .within("num_depths", m.num_depths, 0, kMaxDepths)
      .all_within("depth_m", m.depth_m, 0, kFarthestM)
      .holds(
          std::adjacent_find(m.depth_m.begin(), m.depth_m.end(), std::greater_equal<>()) == m.depth_m.end(),
          "depth_m", "does not rise")
      .all_within("north_mps", m.north_mps, -kFastestCurrentMps, kFastestCurrentMps)
      .all_within("east_mps", m.east_mps, -kFastestCurrentMps, kFastestCurrentMps)
      .within("tide_amplitude_mps", m.tide_amplitude_mps, 0, kFastestCurrentMps)
      .within("tide_period_s", m.tide_period_s, 1, 1e9)
      .within("tide_phase_rad", m.tide_phase_rad, -2 * kPi, 2 * kPi)
      .within("tide_toward_rad", m.tide_toward_rad, -2 * kPi, 2 * kPi)
      .within("random_deviation_mps", m.random_deviation_mps, 0, kFastestCurrentMps)
      .within("random_time_s", m.random_time_s, 0.1, 1e6)
      .result();
}

std::string problem_in(const vehicle_sensors_t& m) {
  return Checker()
      .utime(m.utime)
      .within("depth_m", m.depth_m, -kFarthestM, kFarthestM)
      .one_of("altitude_status", m.altitude_status, vehicle_sensors_t::ALTITUDE_MEASURED,
              vehicle_sensors_t::ALTITUDE_UNAVAILABLE)
      .within("altitude_m", m.altitude_m, 0, kFarthestM)
      .within("water_speed_mps", m.water_speed_mps, -kFastestMps, kFastestMps)
      .within("heading_rad", m.heading_rad, -2 * kPi, 2 * kPi)
      .within("pitch_rad", m.pitch_rad, -kPi, kPi)
      .within("roll_rad", m.roll_rad, -kPi, kPi)
      .all_within("angular_rate_body_radps", m.angular_rate_body_radps, -kFastestTurnRadps, kFastestTurnRadps)
      .finite("shaft_rpm", m.shaft_rpm)
      .finite("rudder_angle_rad", m.rudder_angle_rad)
      .finite("stern_angle_rad", m.stern_angle_rad)
      .all_finite("thruster_rpm", m.thruster_rpm)
      .result();
}

std::string problem_in(const vehicle_dvl_t& m) {
  Checker checker;
  checker.utime(m.utime)
      .all_within("beam_range_m", m.beam_range_m, 0, kFarthestM)
      .all_within("beam_speed_mps", m.beam_speed_mps, -kFastestMps, kFastestMps)
      .all_within("ground_velocity_body_mps", m.ground_velocity_body_mps, -10 * kFastestMps, 10 * kFastestMps)
      .within("velocity_deviation_mps", m.velocity_deviation_mps, 0, kFastestMps);
  for (const std::int8_t status : m.beam_status) {
    checker.one_of("beam_status", status, vehicle_dvl_t::BEAM_LOCKED, vehicle_dvl_t::BEAM_UNAVAILABLE);
  }
  return checker.result();
}

std::string problem_in(const vehicle_gps_t& m) {
  return Checker()
      .utime(m.utime)
      .all_within("fix_north_m, fix_east_m", std::array{m.fix_north_m, m.fix_east_m}, -kFarthestM, kFarthestM)
      .within("fix_deviation_m", m.fix_deviation_m, 0, kFarthestM)
      .result();
}

std::string problem_in(const vehicle_sonar_t& m) {
  Checker checker;
  checker.utime(m.utime)
      .within("fan_tilt_rad", m.fan_tilt_rad, -kPi, kPi)
      .within("greatest_range_m", m.greatest_range_m, 0, kFarthestM)
      .within("num_fan_rays", m.num_fan_rays, 1, kMaxFanRays)
      .all_within("fan_azimuth_rad", m.fan_azimuth_rad, -kPi, kPi)
      .all_within("echo_range_m", m.echo_range_m, 0, kFarthestM);
  for (const std::int8_t status : m.echo_status) {
    checker.one_of("echo_status", status, vehicle_sonar_t::ECHO, vehicle_sonar_t::ECHO_UNAVAILABLE);
  }
  return checker.result();
}

std::string problem_in(const vehicle_usbl_t& m) {
  return Checker()
      .utime(m.utime)
      .id("peer_id", m.peer_id)
      .one_of("packet_kind", m.packet_kind, modem_receive_t::DATA, modem_receive_t::PING_REPLY)
      .within("peer_bearing_rad", m.peer_bearing_rad, -2 * kPi, 2 * kPi)
      .within("peer_elevation_rad", m.peer_elevation_rad, -kPi, kPi)
      .within("angle_deviation_rad", m.angle_deviation_rad, 0, kPi)
      .within("one_way_travel_time_s", m.one_way_travel_time_s, 0, 1e6)
      .result();
}

std::string problem_in(const vehicle_fault_t& m) {
  return Checker()
      .utime(m.utime)
      .one_of("fault_kind", m.fault_kind, vehicle_fault_t::STUCK_RUDDER, vehicle_fault_t::DEAD_SENSOR)
      .within("stuck_angle_rad", m.stuck_angle_rad, -kPi, kPi)
      .within("leak_rate_kg_s", m.leak_rate_kg_s, -kMaxWater, kMaxWater)
      .within("leak_volume_m3", m.leak_volume_m3, 0, kMaxWater)
      .one_of("dead_sensor", m.dead_sensor, vehicle_fault_t::DEPTH, vehicle_fault_t::USBL)
      .result();
}

}  // namespace halocline::bus
