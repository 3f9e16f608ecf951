// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/vehicle_sim_messages.h"

#include <algorithm>
#include <array>
#include <type_traits>

#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/sensors/sensor_errors.h"

namespace halocline::vehicle_sim {
namespace {

constexpr double kSecondsPerMinute = 60;

void write(const Vec3& from, double (&to)[3]) { std::copy(from.data(), from.data() + 3, to); }
Vec3 read(const double (&from)[3]) { return {from[0], from[1], from[2]}; }

using ThrusterSpeeds = std::array<double, kMaxThrusters>;
static_assert(std::extent_v<decltype(vehicle_command_t::thruster_rpm)> == kMaxThrusters);

void write_rpm(const ThrusterSpeeds& from_hz, double (&to)[kMaxThrusters]) {
  std::transform(from_hz.begin(), from_hz.end(), to, [](double hz) { return hz * kSecondsPerMinute; });
}
ThrusterSpeeds read_rpm(const double (&from)[kMaxThrusters]) {
  ThrusterSpeeds hz;
  std::transform(from, from + kMaxThrusters, hz.begin(), [](double rpm) { return rpm / kSecondsPerMinute; });
  return hz;
}

DropWeightState weight_of(std::int8_t released) {
  return released != 0 ? DropWeightState::kReleased : DropWeightState::kHeld;
}

// The constants of vehicle_sensors_t, vehicle_dvl_t and vehicle_sonar_t have the values of AltitudeStatus.
std::int8_t to_wire(AltitudeStatus status) { return static_cast<std::int8_t>(status); }
static_assert(static_cast<int>(AltitudeStatus::kMeasured) == 0 &&
              static_cast<int>(AltitudeStatus::kNoBottom) == 1 &&
              static_cast<int>(AltitudeStatus::kUnavailable) == 2);

}  // namespace

vehicle_state_t to_state_message(SimTime when, std::int32_t vehicle_id, const KinematicState& state) {
  vehicle_state_t m{};
  m.utime = when.to_utime();
  m.vehicle_id = vehicle_id;
  write(state.pose.position_ned_m, m.position_ned_m);
  const Quaternion& q = state.pose.orientation;
  const double wxyz[] = {q.w(), q.x(), q.y(), q.z()};
  std::copy(std::begin(wxyz), std::end(wxyz), m.orientation_wxyz);
  write(state.velocity_ned_mps, m.velocity_ned_mps);
  write(state.angular_velocity_body_radps, m.angular_velocity_body_radps);
  return m;
}

TimedCommand from_message(const vehicle_command_t& m) {
  return {SimTime::from_utime(m.utime),
          {m.rudder_rad, m.stern_plane_rad, m.propeller_rpm / kSecondsPerMinute, read_rpm(m.thruster_rpm),
           m.buoyancy_m3, m.moving_mass_m, weight_of(m.release_weight)}};
}

vehicle_sensors_t to_sensors_message(SimTime when, const SensorReading& r) {
  vehicle_sensors_t m{};
  m.utime = when.to_utime();
  m.depth_m = r.depth_m;
  m.depth_fresh = r.depth_fresh ? 1 : 0;
  m.altitude_status = to_wire(r.altitude.status);
  m.altitude_m = r.altitude.range_m;
  m.water_speed_fresh = r.water_speed_fresh ? 1 : 0;
  m.water_speed_mps = r.water_speed_mps;
  m.attitude_fresh = r.attitude_fresh ? 1 : 0;
  m.heading_rad = r.attitude.yaw;
  m.pitch_rad = r.attitude.pitch;
  m.roll_rad = r.attitude.roll;
  m.angular_rate_fresh = r.angular_rate_fresh ? 1 : 0;
  write(r.angular_velocity_body_radps, m.angular_rate_body_radps);
  m.shaft_rpm = r.actuators.propeller_hz * kSecondsPerMinute;
  m.rudder_angle_rad = r.actuators.rudder_rad;
  m.stern_angle_rad = r.actuators.stern_planes_rad;
  write_rpm(r.actuators.thruster_hz, m.thruster_rpm);
  m.buoyancy_m3 = r.actuators.buoyancy_m3;
  m.moving_mass_m = r.actuators.moving_mass_m;
  m.weight_released = r.actuators.weight == DropWeightState::kReleased ? 1 : 0;
  m.safe_state = r.safe_state ? 1 : 0;
  m.on_seabed = r.on_seabed ? 1 : 0;
  return m;
}

CurrentSettings from_message(const current_change_t& m) {
  CurrentSettings c;
  c.uniform_ned_mps = read(m.uniform_ned_mps);
  for (std::size_t i = 0; i < m.depth_m.size(); ++i)
    c.by_depth.push_back({m.depth_m[i], m.north_mps[i], m.east_mps[i]});
  c.tide = {m.tide_amplitude_mps, m.tide_period_s, m.tide_phase_rad, m.tide_toward_rad};
  c.random = {m.random_deviation_mps, m.random_time_s};
  return c;
}

vehicle_dvl_t to_dvl_message(SimTime when, const DvlReading& r, double deviation_mps) {
  vehicle_dvl_t m{};
  m.utime = when.to_utime();
  for (std::size_t k = 0; k < r.beams.size(); ++k) {
    m.beam_status[k] = to_wire(r.beams[k].status);
    m.beam_range_m[k] = r.beams[k].range_m;
    m.beam_speed_mps[k] = r.beam_speed_mps[k];
  }
  m.ground_velocity_valid = r.valid ? 1 : 0;
  write(r.ground_velocity_body_mps, m.ground_velocity_body_mps);
  m.velocity_deviation_mps = deviation_mps;
  return m;
}

vehicle_gps_t to_gps_message(SimTime when, const GpsFix& fix, double deviation_m) {
  vehicle_gps_t m{};
  m.utime = when.to_utime();
  m.fix_north_m = fix.north_east_m.x();
  m.fix_east_m = fix.north_east_m.y();
  m.fix_deviation_m = deviation_m;
  return m;
}

vehicle_sonar_t to_sonar_message(SimTime when, const SonarSettings& sonar, const std::vector<Echo>& echoes) {
  vehicle_sonar_t m{};
  m.utime = when.to_utime();
  m.fan_tilt_rad = sonar.tilt_rad;
  m.max_range_m = sonar.range_m;
  m.num_fan_rays = static_cast<std::int32_t>(echoes.size());
  m.fan_azimuth_rad = sonar_azimuths_rad(sonar);
  for (const Echo& echo : echoes) {
    m.echo_status.push_back(to_wire(echo.status));
    m.echo_range_m.push_back(echo.range_m);
  }
  return m;
}

vehicle_usbl_t to_usbl_message(const UsblFix& fix, double deviation_rad) {
  vehicle_usbl_t m{};
  m.utime = fix.when.to_utime();
  m.peer_id = fix.packet.source_id;
  m.packet_kind = fix.packet.kind;
  m.send_session = fix.packet.session;
  m.packet_sequence = fix.packet.sequence;
  m.peer_bearing_rad = fix.direction.bearing_rad;
  m.peer_elevation_rad = fix.direction.elevation_rad;
  m.angle_deviation_rad = deviation_rad;
  m.travel_time_known = fix.travel_time_s ? 1 : 0;
  m.one_way_travel_time_s = fix.travel_time_s.value_or(0);
  return m;
}

vehicle_battery_t to_battery_message(SimTime when, std::int32_t vehicle_id, const Battery& battery,
                                     bool has_power) {
  vehicle_battery_t m{};
  m.utime = when.to_utime();
  m.vehicle_id = vehicle_id;
  m.battery_empty = has_power ? 0 : 1;
  m.capacity_j = battery.capacity_j();
  m.energy_left_j = battery.left_j();
  m.hotel_energy_j = battery.hotel_j();
  m.shaft_energy_j = battery.shaft_j();
  m.transmit_energy_j = battery.transmit_j();
  m.receive_energy_j = battery.receive_j();
  return m;
}

vehicle_fault_t to_fault_message(const Fault& fault, bool from_scenario) {
  vehicle_fault_t m{};
  m.utime = fault.from.to_utime();
  m.fault_kind = static_cast<std::int8_t>(fault.kind);
  m.fault_fixed = fault.fixed ? 1 : 0;
  m.stuck_angle_given = fault.angle_rad ? 1 : 0;
  m.stuck_angle_rad = fault.angle_rad.value_or(0);
  m.leak_rate_kg_s = fault.leak_rate_kg_s;
  m.leak_volume_m3 = fault.leak_volume_m3;
  m.dead_sensor = static_cast<std::int8_t>(fault.sensor);
  m.from_scenario = from_scenario ? 1 : 0;
  return m;
}

Fault from_message(const vehicle_fault_t& m) {
  Fault fault{.from = SimTime::from_utime(m.utime),
              .kind = static_cast<FaultKind>(m.fault_kind),
              .fixed = m.fault_fixed != 0,
              .angle_rad = {},
              .leak_rate_kg_s = m.leak_rate_kg_s,
              .leak_volume_m3 = m.leak_volume_m3,
              .sensor = static_cast<SensorKind>(m.dead_sensor)};
  if (m.stuck_angle_given) fault.angle_rad = m.stuck_angle_rad;
  return fault;
}

PacketKey key_of(const packet_outcome_t& m) {
  return {m.source_id, m.packet_kind, m.send_session, m.packet_sequence};
}
PacketKey key_of(const modem_receive_t& m) {
  return {m.source_id, m.packet_kind, m.send_session, m.packet_sequence};
}

SoundArrival arrival_of(const packet_outcome_t& m) {
  return {SimTime::from_utime(m.departure_utime) + SimDuration::from_seconds(m.travel_time_s),
          m.arrival_azimuth_rad, m.arrival_elevation_rad};
}

std::optional<double> travel_time_of(const modem_receive_t& m) {
  if (m.packet_kind == modem_receive_t::PING_REPLY) return m.two_way_travel_time_s / 2;
  return m.stamped ? std::optional(m.travel_time_s) : std::nullopt;
}

ray_query_t to_ray_query(SimTime when, const std::string& client, std::int64_t request_id,
                         const std::vector<EchoBeam>& beams) {
  ray_query_t m{};
  m.utime = when.to_utime();
  m.client_name = client;
  m.request_id = request_id;
  m.query_mode = ray_query_t::CLOSEST_HIT;
  m.num_rays = static_cast<std::int32_t>(beams.size());
  const auto list = [](const Vec3& v) { return std::vector<double>{v.x(), v.y(), v.z()}; };
  for (const EchoBeam& beam : beams) {
    m.offset_m.push_back(list(beam.origin_ned_m));
    m.direction.push_back(list(beam.direction_ned));
    m.max_range_m.push_back(beam.range_m);
  }
  return m;
}

std::vector<Echo> echoes_from(const ray_reply_t& reply, std::size_t beams) {
  std::vector<Echo> echoes(beams);
  if (reply.reply_status != ray_reply_t::OK || reply.ray_status.size() != beams) return echoes;
  for (std::size_t i = 0; i < beams; ++i) {
    const std::int8_t status = reply.ray_status[i];
    if (status == ray_reply_t::HIT) {
      echoes[i] = {AltitudeStatus::kMeasured, reply.result_m[i]};
    } else if (status == ray_reply_t::BELOW_BOTTOM) {
      echoes[i] = {AltitudeStatus::kMeasured, 0};  // the sensor is below the seabed that the hull rests on
    } else if (status != ray_reply_t::BAD_INPUT) {
      echoes[i] = {AltitudeStatus::kNoBottom, 0};
    }
  }
  return echoes;
}

}  // namespace halocline::vehicle_sim
