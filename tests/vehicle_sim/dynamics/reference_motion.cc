// SPDX-License-Identifier: BSD-3-Clause
#include "tests/vehicle_sim/dynamics/reference_motion.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/frames.h"
#include "core/units.h"
#include "tests/support/csv.h"
#include "vehicle_sim/dynamics/vehicle_state.h"

namespace halocline::vehicle_sim::testing {
namespace {

constexpr double kSecondsPerMinute = 60;

ActuatorValues read_actuators(const halocline::testing::CsvRow& row, const std::string& prefix) {
  return {row.number(prefix + "_rudder"), row.number(prefix + "_stern"),
          row.number(prefix + "_rpm") / kSecondsPerMinute};
}

double difference(const ActuatorValues& a, const ActuatorValues& b) {
  return std::max({std::abs(a.rudder_rad - b.rudder_rad), std::abs(a.stern_planes_rad - b.stern_planes_rad),
                   std::abs(a.propeller_hz - b.propeller_hz)});
}

void widen(Deviation& d, const VehicleState& state, const ReferenceSample& sample) {
  d.position_m = std::max(d.position_m, (state.position_ned_m - sample.position).norm());
  d.angle_rad = std::max(d.angle_rad, state.orientation.angularDistance(to_quaternion(sample.attitude)));
  d.velocity = std::max(d.velocity, (state.velocity_body - sample.velocity).cwiseAbs().maxCoeff());
  d.actuator = std::max(d.actuator, difference(state.actuators, sample.actuators));
}

}  // namespace

std::vector<ReferenceSample> read_trajectory(const std::string& file) {
  std::vector<ReferenceSample> samples;
  for (const auto& row : halocline::testing::read_reference_csv(file)) {
    ReferenceSample s;
    s.time_s = row.number("t");
    s.position = {row.number("x_n"), row.number("y_e"), row.number("z_d")};
    s.attitude = {row.number("phi"), row.number("theta"), row.number("psi")};
    s.velocity << row.number("u"), row.number("v"), row.number("w"), row.number("p"), row.number("q"),
        row.number("r");
    s.command = read_actuators(row, "cmd");
    s.actuators = read_actuators(row, "act");
    samples.push_back(s);
  }
  return samples;
}

VehicleState to_state(const ReferenceSample& sample) {
  return {sample.position, to_quaternion(sample.attitude), sample.velocity, sample.actuators};
}

Vec3 current_toward(double speed_mps, double azimuth_deg) {
  const double azimuth = to_radians(azimuth_deg);
  return {speed_mps * std::cos(azimuth), speed_mps * std::sin(azimuth), 0};
}

Deviation deviation_along(const Model& model, const std::string& file, const Water& water,
                          int steps_per_second) {
  const std::vector<ReferenceSample> samples = read_trajectory(file);
  VehicleState state = to_state(samples.front());
  Deviation deviation;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double interval = samples[i].time_s - samples[i - 1].time_s;
    const int steps = static_cast<int>(std::lround(interval * steps_per_second));
    for (int k = 0; k < steps; ++k)
      state = rk4_step(model, state, samples[i - 1].command, water, interval / steps);
    widen(deviation, state, samples[i]);
  }
  return deviation;
}

}  // namespace halocline::vehicle_sim::testing
