// SPDX-License-Identifier: BSD-3-Clause
// Vehicle models as TOML files: every parameter with its unit and range, and where a model of a scenario
// comes from.
//
// A file starts from nothing (an effect that it does not name is absent) or, with `based_on`, from a built-in
// model. Its [sensors] are those that such a vehicle carries unless a scenario sets them
// (vehicle_sim_config.h). Unknown keys, wrong types and impossible values are errors with file, line, key and
// what is allowed. docs/vehicles.md explains the parameters; models/vehicles/ holds the built-in models as
// such files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bus/config/config.h"
#include "core/files/file_path.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/sensors/sensor_settings.h"

namespace halocline::vehicle_sim {

// Visits every parameter as the keys of the current table.
void visit(bus::ConfigVisitor& v, ModelParameters& parameters);

// True for what names a file rather than a built-in model.
bool names_a_model_file(const FilePath& model);

// What such a file holds.
struct ModelFile {
  ModelParameters parameters;
  std::optional<SensorSettings> sensors;  // where it has [sensors]
};

// A built-in model by name, or a file (ending in .toml). Throws
// bus::ConfigErrors with what is wrong in the file, InvalidArgument for a name that is none.
ModelFile load_model(const FilePath& model);

// The same from text; `name_for_errors` stands for the file.
ModelFile parse_model(const std::string& text, const std::string& name_for_errors);

// The model as a file, every key with unit, range and meaning.
std::string model_toml(const ModelFile& model);

}  // namespace halocline::vehicle_sim
