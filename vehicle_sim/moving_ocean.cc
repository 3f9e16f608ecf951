// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/moving_ocean.h"

#include "core/units.h"
#include "ocean/ocean_field_reader.h"

namespace halocline::vehicle_sim {

std::shared_ptr<const ocean::OceanField> moving_ocean(const bus::Scenario& scenario) {
  const bus::OceanEntry& entry = scenario.ocean;
  if (entry.file.empty() || !entry.moves_vehicles) return nullptr;
  auto field = ocean::read_ocean_field(
      {entry.file.place(),
       entry.start_date,
       {to_radians(scenario.origin_latitude_deg), to_radians(scenario.origin_longitude_deg)}});
  return field->has_current() ? field : nullptr;
}

}  // namespace halocline::vehicle_sim
