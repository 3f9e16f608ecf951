// SPDX-License-Identifier: BSD-3-Clause
// Summary of a run in about ten lines: the ways of vehicles, the packets received by each pair, and the
// losses with their causes.
#pragma once

#include <string>
#include <vector>

#include "runs/timeline/run_timeline.h"

namespace halocline::clients {

struct SummaryRow {
  std::string key;   // a vehicle, "packets", "received", "lost", ...; empty: continues the row above
  std::string text;  // without a full stop
};

// Returns the rows of the summary. More than six vehicles or pairs are summed up in one row.
std::vector<SummaryRow> run_summary(const RunTimeline& timeline);

}  // namespace halocline::clients
