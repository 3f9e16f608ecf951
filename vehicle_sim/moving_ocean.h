// SPDX-License-Identifier: BSD-3-Clause
// The ocean's field of a scenario whose currents move vehicles.
#pragma once

#include <memory>
#include <string>

#include "bus/runtime/scenario.h"
#include "ocean/ocean_field.h"

namespace halocline::vehicle_sim {

// Null where the scenario has no file, or none with currents, or they do not count. Throws
// InvalidArgument where its file cannot be read (ocean/ocean_field_reader.h).
std::shared_ptr<const ocean::OceanField> moving_ocean(const bus::Scenario& scenario);

}  // namespace halocline::vehicle_sim
