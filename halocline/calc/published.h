// SPDX-License-Identifier: BSD-3-Clause
// Ranges for which the formulas of `halocline calc` were published, by quantity, model and column.
#pragma once

#include <string>

#include "acoustics/sea/published_range.h"

namespace halocline::clients {

// Returns the range in the units of the column; unlimited when the author states none.
acoustics::PublishedRange published_range(const std::string& quantity, const std::string& model,
                                          const std::string& column);

}  // namespace halocline::clients
