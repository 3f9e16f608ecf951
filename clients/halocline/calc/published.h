// SPDX-License-Identifier: BSD-3-Clause
// The range for which a formula of `halocline calc` was published, by quantity, model and column.
#pragma once

#include <string>

#include "acoustics/sea/published_range.h"

namespace halocline::clients {

// In the units of the column; unlimited where its author states none.
acoustics::PublishedRange published_range(const std::string& quantity, const std::string& model,
                                          const std::string& column);

}  // namespace halocline::clients
