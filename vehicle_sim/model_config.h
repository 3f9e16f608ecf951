// SPDX-License-Identifier: BSD-3-Clause
// Vehicle models as TOML files: every parameter with its unit and range, and the loading of a scenario's
// models.
//
// A file starts from an empty model (an effect that it does not name is absent) or, with `based_on`, from a
// built-in one. Its [sensors] are those that such a vehicle carries unless a scenario sets them
// (vehicle_sim_config.h). Unknown keys, wrong types and values out of range are errors that name file, line,
// key and the allowed values. docs/vehicles.md explains the parameters; models/vehicles/ holds the built-in
// models as such files.
#pragma once

#include <optional>
#include <string>

#include "bus/config/config.h"
#include "core/files/file_path.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/sensors/sensor_settings.h"

namespace halocline::vehicle_sim {

// Visits every parameter as a key of the current table.
void visit(bus::ConfigVisitor& v, ModelParameters& parameters);

// True when `model` names a file rather than a built-in model.
bool names_a_model_file(const FilePath& model);

struct ModelFile {
  ModelParameters parameters;
  std::optional<SensorSettings> sensors;  // empty without [sensors]
};

// Loads a built-in model by name, or a file (ending in .toml). Throws bus::ConfigErrors when the file has
// errors, and InvalidArgument for an unknown name.
ModelFile load_model(const FilePath& model);

// Loads a model from text; `name_for_errors` takes the place of the file's name.
ModelFile parse_model(const std::string& text, const std::string& name_for_errors);

// Returns the model as a file, every key with unit, range and meaning.
std::string model_toml(const ModelFile& model);

}  // namespace halocline::vehicle_sim
