// The vehicles that come with the program, by name.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vehicle_sim/dynamics/vehicle_model.h"

namespace halocline::vehicle_sim {

// The names, the default of scenarios first.
const std::vector<std::string>& built_in_models();

// The parameters of that name; empty when there is none. `remus100-pvs` handles a current exactly here
// (CurrentTreatment::kGalilean); set kUpstream for the published treatment.
std::optional<ModelParameters> built_in_model(std::string_view name);

// One line about it.
std::string purpose_of_model(std::string_view name);

}  // namespace halocline::vehicle_sim
