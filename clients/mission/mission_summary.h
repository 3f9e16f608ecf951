// SPDX-License-Identifier: BSD-3-Clause
// A mission in about ten lines: who went where, who received whom, what was lost and why.
#pragma once

#include <string>
#include <vector>

#include "clients/mission/mission_store.h"

namespace halocline::clients {

struct SummaryRow {
  std::string key;   // a vehicle, "packets", "received", "lost", ...; empty: goes on with the row above
  std::string text;  // without a full stop
};

// Of more than six vehicles or pairs one row stands for all.
std::vector<SummaryRow> mission_summary(const MissionStore& mission);

}  // namespace halocline::clients
