#include "clients/autopilot/autopilot_messages.h"

#include <algorithm>

namespace halocline::clients {

Vec3 position_of(const vehicle_state_t& state) {
  return {state.position_ned_m[0], state.position_ned_m[1], state.position_ned_m[2]};
}

Measured to_measured(const vehicle_state_t& state) {
  const double* q = state.orientation_wxyz;
  const Quaternion orientation = Quaternion(q[0], q[1], q[2], q[3]).normalized();
  const EulerAngles euler = to_euler(orientation);
  const Vec3 velocity(state.velocity_ned_mps[0], state.velocity_ned_mps[1], state.velocity_ned_mps[2]);
  return {.z_ned_m = state.position_ned_m[2],
          .heading_rad = euler.yaw,
          .pitch_rad = euler.pitch,
          .pitch_rate_radps = state.angular_velocity_body_radps[1],
          .yaw_rate_radps = state.angular_velocity_body_radps[2],
          .speed_mps = (orientation.conjugate() * velocity).x()};
}

HoverMeasured to_hover_measured(const vehicle_state_t& state) {
  const Measured m = to_measured(state);
  const Vec3 velocity(state.velocity_ned_mps[0], state.velocity_ned_mps[1], state.velocity_ned_mps[2]);
  return {position_of(state), velocity, m.heading_rad, m.pitch_rad, m.pitch_rate_radps, m.yaw_rate_radps};
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
