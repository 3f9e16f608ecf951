// SPDX-License-Identifier: BSD-3-Clause
// JSON output of `halocline link --json`, and the names in it.
#pragma once

#include <string>
#include <string_view>

#include "acoustics/reception/disturbing_powers.h"
#include "channel_server/links/link_table.h"
#include "channel_server/propagation/propagation.h"
#include "simulation/link_survey.h"

namespace halocline::clients {

std::string_view name_of(channel_server::Multipath multipath);          // "unlikely", "likely", "unknown"
std::string_view name_of(channel_server::PathState state);              // "open", "shadow", ...
std::string_view name_of(channel_server::PropagationUsed propagation);  // "straight", "rays", ...
std::string_view name_of(acoustics::LossReason reason);                 // "none", "noise", ...

// Returns a JSON object with the numbers of the link budget, the paths and the forecast, whose names end in
// their units; without a line break at the end.
std::string to_json(const LinkSurveyEnd& from, const LinkSurveyEnd& to, const LinkSurvey& answer);

}  // namespace halocline::clients
