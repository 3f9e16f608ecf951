// SPDX-License-Identifier: BSD-3-Clause
// Ocean field of a scenario as far as its currents move vehicles.
#pragma once

#include <memory>

#include "bus/config/scenario.h"
#include "ocean/ocean_field.h"

namespace halocline::vehicle_sim {

// Returns the field; null when the scenario has no file, its file has no currents, or the currents do not
// move vehicles in this scenario. Throws InvalidArgument when the file cannot be read
// (ocean/ocean_field_reader.h).
std::shared_ptr<const ocean::OceanField> moving_ocean(const bus::Scenario& scenario);

}  // namespace halocline::vehicle_sim
