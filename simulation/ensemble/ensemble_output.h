// SPDX-License-Identifier: BSD-3-Clause
// Bands of a link as text and in JSON.
#pragma once

#include <string>

#include "simulation/ensemble/link_ensemble.h"

namespace halocline::clients {

// Returns lines for the table of `halocline link`: 10, 50 and 90 % of level, SNR and delivery.
std::string to_text(const LinkBands& bands);

// Returns the JSON object `link` with a member "ensemble" that holds the bands, for instance
//   "ensemble": {"members": 20, "snr_db": [-3.1, 4.0, 9.7], ...}
// Without members returns `link` unchanged.
std::string with_bands(const std::string& link, const LinkBands& bands);

}  // namespace halocline::clients
