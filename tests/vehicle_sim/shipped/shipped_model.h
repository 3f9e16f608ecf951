// SPDX-License-Identifier: BSD-3-Clause
// A vehicle of models/vehicles, and how it moves when nothing but water is around.
#pragma once

#include <cmath>
#include <memory>
#include <string>

#include "vehicle_sim/dynamics/equations_of_motion.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/model_config.h"

namespace halocline::vehicle_sim::testing {

inline std::shared_ptr<const Model> shipped(const std::string& name) {
  return std::make_shared<const Model>(load_model(name).parameters);
}

inline VehicleState run(const Model& model, VehicleState state, const ActuatorValues& command,
                        double duration_s, const Water& water = {}, double step_s = 0.01) {
  const auto steps = std::lround(duration_s / step_s);
  for (long i = 0; i < steps; ++i) state = rk4_step(model, state, command, water, step_s);
  return state;
}

}  // namespace halocline::vehicle_sim::testing
