// SPDX-License-Identifier: BSD-3-Clause
// Faults of a vehicle: their effect on its commands, its model and its sensors.
//
// Stuck rudder or stern planes: the servo holds its angle, or drives to a given one within its limits,
// whatever is commanded. Lost propeller: no thrust, no torque on the hull, no drag; its motor turns on as
// commanded. Leak: water comes in at a steady rate up to a volume; it gathers at one point
// (ModelParameters::leak_offset_m from the dry centre of gravity, by default there; no sloshing), and adds
// its mass and inertia to the vehicle's and no buoyancy: off the centre of gravity it trims the hull. What
// comes in moves with the vehicle already: the momentum it takes up is left out. A negative rate pumps out.
// Dead sensor: it measures nothing. Empty battery: propeller and thrusters stop, all else stays where it is,
// no sensor measures anything. Each fault ends when it is mended; the water of a leak stays in.
#pragma once

#include <array>
#include <optional>

#include "core/sim_time.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/sensors/sensor_errors.h"

namespace halocline::vehicle_sim {

// In the order of vehicle_fault_t.
enum class FaultKind { kStuckRudder, kStuckSternPlanes, kLostPropeller, kLeak, kDeadSensor, kEmptyBattery };

struct Fault {
  SimTime from = {};  // holds from the first physics step at or after this
  FaultKind kind = FaultKind::kStuckRudder;
  bool mended = false;                   // ends the fault of this kind (and sensor)
  std::optional<double> angle_rad = {};  // stuck fins; empty: where they are
  double leak_rate_kg_s = 0;             // negative pumps out
  double leak_volume_m3 = 0;             // at most in the hull, 0 or above
  SensorKind sensor = SensorKind::kDepth;
};

class VehicleFaults {
 public:
  using Dead = std::array<bool, kSensorKinds.size()>;  // by SensorKind

  // `now`: where the actuators are.
  void take(const Fault& fault, const ActuatorValues& now);

  // What the actuators do with a command.
  ActuatorValues obeyed(ActuatorValues command) const;

  Dead dead_sensors() const;
  bool has_power() const { return has_power_; }

  // Lets `seconds` of water in or out; `water_density_kg_m3` above 0.
  void leak(double seconds, double water_density_kg_m3);
  double water_inside_kg() const { return water_kg_; }

  // False while the model is that of the sound vehicle.
  bool changes_model() const { return lost_propeller_ || water_kg_ > 0; }
  // True while water comes in or goes out.
  bool is_filling(double water_density_kg_m3) const;
  // The sound vehicle's model with all that is broken now.
  ModelParameters broken(ModelParameters sound) const;

 private:
  std::optional<double> rudder_rad_, stern_planes_rad_;  // where they are stuck
  ActuatorValues left_at_;                               // where the actuators were; read without power
  bool lost_propeller_ = false, has_power_ = true;
  double leak_rate_kg_s_ = 0, leak_volume_m3_ = 0, water_kg_ = 0;
  Dead dead_ = {};
};

}  // namespace halocline::vehicle_sim
