// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/speed_trial.h"

#include <algorithm>
#include <cmath>

#include "clients/onboard/autopilot/control_laws.h"
#include "clients/onboard/autopilot/hover_laws.h"
#include "core/frames.h"
#include "vehicle_sim/dynamics/equations_of_motion.h"
#include "vehicle_sim/dynamics/vehicle_state.h"

namespace halocline::clients {
namespace {

using vehicle_sim::ActuatorValues;
using vehicle_sim::VehicleState;

constexpr double kLongestStep_s = 0.02, kFarAhead_m = 1e5, kRpmPerHz = 60;

// Pilot of a trial: steers north at z = 0.
class TrialPilot {
 public:
  TrialPilot(const PilotConfig& config, double speed_mps) : config_(config), speed_mps_(speed_mps) {}

  ActuatorValues steer(const VehicleState& s, double dt_s) {
    return config_.steering == Steering::kThrusters ? with_thrusters(s, dt_s) : with_fins(s, dt_s);
  }

 private:
  ActuatorValues with_thrusters(const VehicleState& s, double dt_s) {
    const EulerAngles euler = to_euler(s.orientation);
    const StationPoint point{s.position_ned_m + Vec3(kFarAhead_m, 0, -s.position_ned_m.z()), speed_mps_};
    const HoverMeasured measured{s.position_ned_m,   to_kinematic_state(s).velocity_ned_mps,
                                 euler.yaw,          euler.pitch,
                                 s.velocity_body[4], s.velocity_body[5]};
    const auto rpm = hover_command(config_.hover_gains, point, measured, dt_s, hover_integrals_);
    ActuatorValues values;
    for (std::size_t i = 0; i < rpm.size(); ++i) values.thruster_hz[i] = rpm[i] / kRpmPerHz;
    return values;
  }

  ActuatorValues with_fins(const VehicleState& s, double dt_s) {
    const EulerAngles euler = to_euler(s.orientation);
    const Measured measured{s.position_ned_m.z(), euler.yaw,          euler.pitch,
                            s.velocity_body[4],   s.velocity_body[5], s.velocity_body[0]};
    const ActuatorCommand c = command(config_.gains, {.speed_mps = speed_mps_}, measured, dt_s, integrals_);
    return {c.rudder_rad, c.stern_plane_rad, c.propeller_rpm / kRpmPerHz, {}};
  }

  const PilotConfig& config_;
  double speed_mps_;
  Integrals integrals_;
  HoverIntegrals hover_integrals_;
};

}  // namespace

SpeedTrial try_speed(const vehicle_sim::Model& model, const PilotConfig& config, SimDuration command_period,
                     double set_speed_mps) {
  TrialPilot pilot(config, set_speed_mps);
  VehicleState state;
  state.velocity_body[0] = set_speed_mps;
  const double period_s = command_period.seconds();
  const auto steps = static_cast<int>(std::ceil(period_s / kLongestStep_s));
  const auto periods = static_cast<int>(std::ceil(kTrial_s / period_s));
  const int last = std::max(periods / 10, 1);
  vehicle_sim::Water water;
  if (!model.parameters().floats.empty()) water.sea_surface_z_m = 0;
  SpeedTrial trial;
  for (int i = 0; i < periods; ++i) {
    const ActuatorValues values = pilot.steer(state, period_s);
    for (int k = 0; k < steps; ++k) state = rk4_step(model, state, values, water, period_s / steps);
    if (!is_finite(state)) return {};
    trial.depth_error_m = std::max(trial.depth_error_m, std::abs(state.position_ned_m.z()));
    if (i >= periods - last) trial.speed_mps += state.velocity_body[0] / last;
  }
  return trial;
}

}  // namespace halocline::clients
