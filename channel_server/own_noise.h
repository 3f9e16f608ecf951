// SPDX-License-Identifier: BSD-3-Clause
// Noise that a vehicle's own propellers make at its hydrophone, by its model.
//
// Model. The spectrum at 1 m and the loss to the own hydrophone are those of NoiseSource's defaults, at the
// turn rate n at which the blade tips of the largest propeller move at 11 m/s,
//   n = 11 m/s / (pi D),
// 1500 rpm of a propeller of 0.14 m; noise grows with the sixth power of the tips' speed (vehicle_noise.h).
// The speed is our choice. A vehicle is loud to itself long before it is to others, whose paths to it are
// not computed: its noise is heard by others only where the scenario describes it ([vehicle.noise]).
#pragma once

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "channel_server/vehicles/vehicle_noise.h"
#include "core/files/file_path.h"

namespace halocline::channel_server {

// Returns the own noise of a vehicle of this model: a built-in one by name, a file .toml, "fixed" or
// "external". Empty for a model without propellers. Throws bus::ConfigErrors for a file that cannot be read.
std::optional<NoiseSource> propeller_noise(const FilePath& model);

// Returns the names and texts of the built-in models that are files (models/vehicles), compiled in.
const std::vector<std::pair<std::string_view, std::string_view>>& vehicle_model_texts();

}  // namespace halocline::channel_server
