// SPDX-License-Identifier: BSD-3-Clause
// Reads the reference motion of tests/data/vehicle and runs a model along its commands, for tests.
#pragma once

#include <string>
#include <vector>

#include "core/frames.h"
#include "tests/support/csv.h"
#include "vehicle_sim/dynamics/equations_of_motion.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"

namespace halocline::vehicle_sim::testing {

// One row of a trajectory file.
struct ReferenceSample {
  double time_s = 0;
  Vec3 position = Vec3::Zero();
  EulerAngles attitude;  // yaw unwrapped
  Vec6 velocity = Vec6::Zero();
  ActuatorValues command, actuators;
};

std::vector<ReferenceSample> read_trajectory(const std::string& file);

// State of a sample.
VehicleState to_state(const ReferenceSample& sample);

// Velocity toward an azimuth, degrees from north.
Vec3 current_toward(double speed_mps, double azimuth_deg);

// The largest differences along a trajectory.
struct Deviation {
  double position_m = 0;
  double angle_rad = 0;  // of the rotation between the two attitudes
  double velocity = 0;   // m/s or rad/s
  double actuator = 0;   // rad or Hz
};

// Runs `model` from the file's first row with its commands and `steps_per_second`, and compares at every row.
Deviation deviation_along(const Model& model, const std::string& file, const Water& water,
                          int steps_per_second);

}  // namespace halocline::vehicle_sim::testing
