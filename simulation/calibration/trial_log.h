// SPDX-License-Identifier: BSD-3-Clause
// Measurements of a log: the outcomes of its packets as rows of trial data.
//
// An outcome counts when the sea and the receiver decided it alone: packets lost to other packets, to the
// receiver's own transmission, sleep, battery or absence, and to [[extra_loss]] are left out, and so are
// those between modems that never hear each other. Times are those of departure, simulation time.
//
// The forecast of a calibration is between the places where the scenario starts its vehicles, so pairs whose
// range of an outcome differs from theirs by more than a tenth, and 20 m, are left out there; a note tells
// how many.
#pragma once

#include <string>
#include <vector>

#include "bus/logs/log_reader.h"
#include "simulation/calibration/trial_data.h"
#include "simulation/composition.h"

namespace halocline::clients {

struct TrialLog {
  std::vector<TrialRow> rows;  // one packet each
  std::vector<std::string> notes;
};

// Reads a log to its end.
TrialLog read_trial_log(LogReader& log, const ScenarioConfig& config);

}  // namespace halocline::clients
