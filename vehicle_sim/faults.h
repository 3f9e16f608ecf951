// SPDX-License-Identifier: BSD-3-Clause
// Faults of a vehicle: their effects on its commands, its model and its sensors.
//
// - Stuck rudder or stern planes: the servo holds its angle, or drives to a given one within its limits,
//   whatever is commanded.
// - Lost propeller: no thrust, no torque on the hull, no drag; its motor still turns as commanded.
// - Leak: water comes in at a constant rate up to a volume and gathers at one point
//   (ModelParameters::leak_offset_m from the dry centre of gravity, by default at it; no sloshing). It adds
//   its mass and inertia to the vehicle's, and no buoyancy, so that it trims the hull when the point is off
//   the centre of gravity. The momentum that the incoming water takes up is neglected, as if it moved with
//   the vehicle already. A negative rate pumps out.
// - Dead sensor: it measures nothing.
// - Empty battery: propeller and thrusters stop, all other actuators stay where they are, and no sensor
//   measures anything.
//
// Each fault ends when it is repaired; the water of a leak stays in.
#pragma once

#include <array>
#include <optional>

#include "core/sim_time.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/sensors/sensor_errors.h"

namespace halocline::vehicle_sim {

// The order is that of the constants in vehicle_fault_t.
enum class FaultKind { kStuckRudder, kStuckSternPlanes, kLostPropeller, kLeak, kDeadSensor, kEmptyBattery };

struct Fault {
  SimTime from = {};  // applies from the first physics step at or after this
  FaultKind kind = FaultKind::kStuckRudder;
  bool fixed = false;                    // true: ends the fault of this kind (and sensor)
  std::optional<double> angle_rad = {};  // angle of stuck fins; empty: their present angle
  double leak_rate_kg_s = 0;             // negative: pumps out
  double leak_volume_m3 = 0;             // limit of the water in the hull, 0 or above
  SensorKind sensor = SensorKind::kDepth;
};

class VehicleFaults {
 public:
  using Dead = std::array<bool, kSensorKinds.size()>;  // index: SensorKind

  // Starts or ends a fault. `now`: actual positions of the actuators.
  void take(const Fault& fault, const ActuatorValues& now);

  ActuatorValues obeyed(ActuatorValues command) const;

  Dead dead_sensors() const;
  bool has_power() const { return has_power_; }

  // Lets water in or out over `seconds`; `water_density_kg_m3` above 0.
  void leak(double seconds, double water_density_kg_m3);

  // False while the model is that of the vehicle without faults.
  bool changes_model() const { return lost_propeller_ || water_kg_ > 0; }
  // True while water comes in or goes out.
  bool is_filling(double water_density_kg_m3) const;
  // Returns the model with all faults that are present now. `sound`: the model without faults.
  ModelParameters broken(ModelParameters sound) const;

 private:
  std::optional<double> rudder_rad_, stern_planes_rad_;  // angles at which they are stuck
  ActuatorValues left_at_;                               // actuators at the loss of power
  bool lost_propeller_ = false, has_power_ = true;
  double leak_rate_kg_s_ = 0, leak_volume_m3_ = 0, water_kg_ = 0;
  Dead dead_ = {};
};

}  // namespace halocline::vehicle_sim
