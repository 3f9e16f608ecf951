// SPDX-License-Identifier: BSD-3-Clause
// Library of built-in vehicle models, by name: some are programmed, the others are the files of
// models/vehicles, compiled in. load_model (model_config.h) loads either.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vehicle_sim/dynamics/vehicle_model.h"

namespace halocline::vehicle_sim {

// Returns the names; the default of scenarios is the first.
const std::vector<std::string>& built_in_models();
bool is_built_in(std::string_view name);

// Returns the parameters of a programmed model; empty when there is none of that name. `remus100-pvs` treats
// currents exactly here (CurrentTreatment::kGalilean); set kUpstream for the published treatment.
std::optional<ModelParameters> programmed_model(std::string_view name);

struct ModelText {
  const char* name;  // name of the file, without .toml
  const char* toml;
};

// Returns all compiled-in files, in alphabetical order.
const std::vector<ModelText>& built_in_model_texts();
// Returns the file of a built-in model. Throws InvalidArgument when there is none.
std::string built_in_model_text(std::string_view name);

// Returns a one-line description of the model; empty for an unknown name.
std::string purpose_of_model(std::string_view name);

}  // namespace halocline::vehicle_sim
