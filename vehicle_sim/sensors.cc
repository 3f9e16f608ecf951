#include "vehicle_sim/sensors.h"

#include "vehicle_sim/equations_of_motion.h"

namespace halocline::vehicle_sim {

SensorReading measure_fixed(const VehicleState& state, const Water& water) {
  SensorReading reading;
  reading.depth_m = depth_below_surface_m(state.position_ned_m, water.sea_surface_z_m);
  reading.water_speed_mps =
      state.velocity_body[0] - (state.orientation.conjugate() * water.current_ned_mps).x();
  reading.attitude = to_euler(state.orientation);
  reading.angular_velocity_body_radps = state.angular_velocity_body_radps();
  reading.actuators = state.actuators;
  return reading;
}

SensorReading measure(const Model& model, const VehicleState& state, const Water& water) {
  SensorReading reading = measure_fixed(state, water);
  reading.water_speed_mps = relative_flow(model, state, water).nu_r[0];
  return reading;
}

Vec3 altimeter_direction(const VehicleState& state) { return state.orientation * Vec3::UnitZ(); }

}  // namespace halocline::vehicle_sim
