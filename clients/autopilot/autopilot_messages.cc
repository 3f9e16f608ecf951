#include "clients/autopilot/autopilot_messages.h"

#include <algorithm>
#include <cmath>

#include "core/sim_time.h"

namespace halocline::clients {

Situation to_situation(const vehicle_state_t& state) {
  const double* q = state.orientation_wxyz;
  const Quaternion orientation = Quaternion(q[0], q[1], q[2], q[3]).normalized();
  Situation situation;
  situation.time_s = SimTime::from_utime(state.utime).seconds();
  situation.position_ned_m = {state.position_ned_m[0], state.position_ned_m[1], state.position_ned_m[2]};
  situation.velocity_ned_mps = {state.velocity_ned_mps[0], state.velocity_ned_mps[1],
                                state.velocity_ned_mps[2]};
  situation.attitude = to_euler(orientation);
  situation.pitch_rate_radps = state.angular_velocity_body_radps[1];
  situation.yaw_rate_radps = state.angular_velocity_body_radps[2];
  situation.water_speed_mps = (orientation.conjugate() * situation.velocity_ned_mps).x();
  return situation;
}

Situation to_situation(const vehicle_sensors_t& sensors, const Navigator& navigator, double time_s) {
  Situation situation;
  situation.time_s = time_s;
  situation.position_ned_m = navigator.position_ned_m(time_s);
  situation.velocity_ned_mps = navigator.velocity_ned_mps();
  situation.attitude = navigator.has_sample()
                           ? navigator.last().attitude
                           : EulerAngles{sensors.roll_rad, sensors.pitch_rad, sensors.heading_rad};
  situation.pitch_rate_radps = sensors.angular_rate_body_radps[1];
  situation.yaw_rate_radps = sensors.angular_rate_body_radps[2];
  situation.water_speed_mps = sensors.water_speed_mps;
  return situation;
}

AttitudeReading to_attitude_reading(const vehicle_sensors_t& sensors) {
  AttitudeReading reading{.time_s = SimTime::from_utime(sensors.utime).seconds()};
  const double* rates = sensors.angular_rate_body_radps;
  if (sensors.attitude_fresh)
    reading.attitude = EulerAngles{sensors.roll_rad, sensors.pitch_rad, sensors.heading_rad};
  if (sensors.angular_rate_fresh) reading.rates_radps = Vec3(rates[0], rates[1], rates[2]);
  return reading;
}

NavigationSample to_navigation_sample(const vehicle_sensors_t& sensors, const AttitudeKeeper& attitude,
                                      const std::optional<vehicle_dvl_t>& ping) {
  NavigationSample sample{.time_s = SimTime::from_utime(sensors.utime).seconds(),
                          .attitude = attitude.attitude(),
                          .depth_m = sensors.depth_m,
                          .water_speed_mps = sensors.water_speed_mps,
                          .heading_deviation_rad = attitude.heading_deviation_rad()};
  if (ping) {
    const double* v = ping->ground_velocity_body_mps;
    sample.ground_velocity_body_mps = Vec3(v[0], v[1], v[2]);
  }
  return sample;
}

void take_in(const vehicle_gps_t& fix, Navigator& navigator) {
  constexpr double kMinDeviationM = 0.01;
  navigator.fix(fix.fix_north_m, fix.fix_east_m, std::max(fix.fix_deviation_m, kMinDeviationM),
                SimTime::from_utime(fix.utime).seconds());
}

void take_in(const vehicle_usbl_t& bearing, const std::map<std::int32_t, Vec3>& beacons,
             const AcousticFixRules& rules, Navigator& navigator) {
  const double time_s = SimTime::from_utime(bearing.utime).seconds();
  const auto beacon = beacons.find(bearing.peer_id);
  const auto then = navigator.at(time_s);
  if (beacon == beacons.end() || !then || !bearing.travel_time_known) return;
  const BeaconMeasurement measured{bearing.peer_bearing_rad, bearing.peer_elevation_rad,
                                   bearing.angle_deviation_rad, bearing.one_way_travel_time_s};
  const auto fix = place_by_beacon(rules, beacon->second, measured, then->attitude, then->position_ned_m.z());
  if (fix) navigator.fix(fix->north_m, fix->east_m, fix->deviation_m, time_s);
}

void take_in(const position_estimate_t& estimate, Navigator& navigator) {
  if (estimate.estimate_status != position_estimate_t::UNIQUE || !navigator.has_sample()) return;
  const double age_s = navigator.last().time_s - SimTime::from_utime(estimate.utime).seconds();
  const Vec3 way = age_s * navigator.velocity_ned_mps();
  const double variance_m2 = 0.5 * (estimate.covariance_ned_m2[0] + estimate.covariance_ned_m2[4]);
  navigator.replace(estimate.position_ned_m[0] + way.x(), estimate.position_ned_m[1] + way.y(),
                    std::sqrt(std::max(variance_m2, 0.0)));
}

LeaderReport to_report(const Situation& situation) {
  const Vec3& velocity = situation.velocity_ned_mps;
  const double speed = velocity.head<2>().norm();
  // At rest the way it would go is where its bow points.
  const double course = speed > 0.05 ? std::atan2(velocity.y(), velocity.x()) : situation.attitude.yaw;
  return {situation.position_ned_m, course, speed, situation.time_s};
}

AltimeterLook to_look(const vehicle_sensors_t& sensors, const Situation& situation) {
  const double time_s = SimTime::from_utime(sensors.utime).seconds();
  return {
      .time_s = time_s,
      .position_ned_m = situation.position_ned_m + (time_s - situation.time_s) * situation.velocity_ned_mps,
      .attitude = situation.attitude,
      .has_echo = sensors.altitude_status == vehicle_sensors_t::ALTITUDE_MEASURED,
      .altitude_m = sensors.altitude_m};
}

vehicle_command_t to_message(const std::array<double, 4>& thruster_rpm) {
  vehicle_command_t message{};
  std::copy(thruster_rpm.begin(), thruster_rpm.end(), message.thruster_rpm);
  return message;
}

vehicle_command_t to_message(const ActuatorCommand& command) {
  vehicle_command_t message{};
  message.propeller_rpm = command.propeller_rpm;
  message.rudder_rad = command.rudder_rad;
  message.stern_plane_rad = command.stern_plane_rad;
  return message;
}

}  // namespace halocline::clients
