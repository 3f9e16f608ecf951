// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/faults.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/frames.h"

namespace halocline::vehicle_sim {

void VehicleFaults::take(const Fault& fault, const ActuatorValues& now) {
  const auto stick = [&](std::optional<double>& stuck, double angle) {
    stuck = fault.fixed ? std::nullopt : std::optional(fault.angle_rad.value_or(angle));
  };
  switch (fault.kind) {
    case FaultKind::kStuckRudder:
      return stick(rudder_rad_, now.rudder_rad);
    case FaultKind::kStuckSternPlanes:
      return stick(stern_planes_rad_, now.stern_planes_rad);
    case FaultKind::kLostPropeller:
      lost_propeller_ = !fault.fixed;
      return;
    case FaultKind::kLeak:
      require(std::isfinite(fault.leak_rate_kg_s), "the rate of a leak is not finite");
      require(fault.leak_volume_m3 >= 0, "the volume of a leak is 0 or above");
      leak_rate_kg_s_ = fault.fixed ? 0 : fault.leak_rate_kg_s;
      leak_volume_m3_ = fault.leak_volume_m3;
      return;
    case FaultKind::kDeadSensor:
      dead_.at(static_cast<std::size_t>(fault.sensor)) = !fault.fixed;
      return;
    case FaultKind::kEmptyBattery:
      has_power_ = fault.fixed;
      left_at_ = now;
      return;
  }
}

VehicleFaults::Dead VehicleFaults::dead_sensors() const {
  if (has_power_) return dead_;
  Dead all;
  all.fill(true);
  return all;
}

ActuatorValues VehicleFaults::obeyed(ActuatorValues command) const {
  if (!has_power_) {  // actuators that do not spin stay where they are
    ActuatorValues still = left_at_;
    still.propeller_hz = 0;
    still.thruster_hz = {};
    return still;
  }
  command.rudder_rad = rudder_rad_.value_or(command.rudder_rad);
  command.stern_planes_rad = stern_planes_rad_.value_or(command.stern_planes_rad);
  return command;
}

bool VehicleFaults::is_filling(double water_density_kg_m3) const {
  return (leak_rate_kg_s_ > 0 && water_kg_ < leak_volume_m3_ * water_density_kg_m3) ||
         (leak_rate_kg_s_ < 0 && water_kg_ > 0);
}

void VehicleFaults::leak(double seconds, double water_density_kg_m3) {
  if (!is_filling(water_density_kg_m3)) return;
  const double max_water_kg = leak_rate_kg_s_ > 0 ? leak_volume_m3_ * water_density_kg_m3 : water_kg_;
  water_kg_ = std::clamp(water_kg_ + leak_rate_kg_s_ * seconds, 0.0, max_water_kg);
}

ModelParameters VehicleFaults::broken(ModelParameters sound) const {
  // Vehicle and water as one body, with the reduced mass mu at the distance r between their centres:
  //
  //   r_g' = r_g + m_w / (m + m_w) r
  //   I'   = I + mu (r^2 1 - r r^T),  mu = m m_w / (m + m_w)
  const double dry_kg = sound.mass_kg, all_kg = dry_kg + water_kg_;
  const Vec3& r = sound.leak_offset_m;
  sound.inertia_kg_m2 +=
      dry_kg * water_kg_ / all_kg * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
  sound.center_of_gravity_m += water_kg_ / all_kg * r;
  sound.mass_kg = all_kg;
  if (lost_propeller_) {
    sound.propeller.thrust_share = sound.propeller.torque_share = 0;
    sound.propeller.torque_at_rest = sound.propeller.torque_at_max = 0;
  }
  return sound;
}

}  // namespace halocline::vehicle_sim
