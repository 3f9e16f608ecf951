// SPDX-License-Identifier: BSD-3-Clause
// The vehicles that come with the program, by name: some are programmed, the others are the files of
// models/vehicles, compiled in. load_model (model_config.h) makes parameters of either.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vehicle_sim/dynamics/vehicle_model.h"

namespace halocline::vehicle_sim {

// The names, the default of scenarios first.
const std::vector<std::string>& built_in_models();
bool is_built_in(std::string_view name);

// The parameters of a programmed one of that name; empty when there is none. `remus100-pvs` handles a current
// exactly here (CurrentTreatment::kGalilean); set kUpstream for the published treatment.
std::optional<ModelParameters> programmed_model(std::string_view name);

struct ModelText {
  const char* name;  // of the file, without .toml
  const char* toml;
};

// All files, in alphabetical order.
const std::vector<ModelText>& built_in_model_texts();
// That of a built-in model.
std::string built_in_model_text(std::string_view name);

// One line about it.
std::string purpose_of_model(std::string_view name);

}  // namespace halocline::vehicle_sim
