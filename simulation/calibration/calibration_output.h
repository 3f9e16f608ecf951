// SPDX-License-Identifier: BSD-3-Clause
// A calibration as text for people, and as keys for the scenario to include.
#pragma once

#include <string>

#include "simulation/calibration/calibration.h"
#include "simulation/composition.h"

namespace halocline::clients {

// Returns what the trial tells, what it does not, and the pairs left out in turn.
std::string to_text(const Calibration& calibration);

// Returns the calibrated keys of the scenario as TOML, and their remaining spreads as [uncertainty]. The
// scenario names the file that holds them by `include`; `source` names the trial in a comment. Without a
// number that the trial tells there are comments alone.
std::string to_toml(const Calibration& calibration, const ScenarioConfig& config, const std::string& source);

}  // namespace halocline::clients
