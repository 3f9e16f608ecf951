// What a vehicle measures of itself: the readings of its sensors without noise.
//
// Left out: noise, bias, drop-outs, the sensors' places on the hull (all measure at CO), the altimeter's beam width.
#pragma once

#include "vehicle_sim/vehicle_state.h"

namespace halocline::vehicle_sim {

enum class AltitudeStatus {
  kMeasured,
  kNoBottom,     // none within the altimeter's range, or beyond the known terrain
  kUnavailable,  // nobody answered where the bottom is
};

struct SensorReading {
  double depth_m = 0;  // below the sea surface, positive down
  AltitudeStatus altitude_status = AltitudeStatus::kUnavailable;
  double altitude_m = 0;       // along the body's down axis to the seabed; 0 unless measured
  double water_speed_mps = 0;  // along the body's forward axis, relative to the water
  EulerAngles attitude;        // rad; yaw is the heading, clockwise from north, -pi to pi
  Vec3 angular_velocity_body_radps = Vec3::Zero();
  ActuatorValues actuators;  // actual
  bool safe_state = false;   // commands have timed out
  bool on_seabed = false;    // the hull touches the ground
};

// Everything but altitude, safe state and contact, which are not the vehicle's own to know. `water` as the vehicle has
// it; its sea surface finite.
SensorReading measure(const Model& model, const VehicleState& state, const Water& water);

// The same for a node that is moored: a pose that never changes in a current, without actuators.
SensorReading measure_fixed(const VehicleState& state, const Water& water);

// The altimeter's beam: the body's down axis in the world frame, unit.
Vec3 altimeter_direction(const VehicleState& state);

}  // namespace halocline::vehicle_sim
