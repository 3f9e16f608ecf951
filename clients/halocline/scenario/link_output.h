// SPDX-License-Identifier: BSD-3-Clause
// The answer of `halocline link --json`, and the names in it.
#pragma once

#include <string>
#include <string_view>

#include "channel_server/links/link_table.h"
#include "channel_server/propagation/propagation.h"
#include "clients/halocline/scenario/link_survey.h"

namespace halocline::clients {

std::string_view name_of(channel_server::Multipath multipath);          // "unlikely", "likely", "unknown"
std::string_view name_of(channel_server::PathState state);              // "open", "shadow", ...
std::string_view name_of(channel_server::PropagationUsed propagation);  // "straight", "rays", ...

// An object with the numbers of the budget, the path and the forecast, names with units; no line break at the
// end.
std::string to_json(const LinkSurveyEnd& from, const LinkSurveyEnd& to, const LinkSurvey& answer);

}  // namespace halocline::clients
