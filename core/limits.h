// SPDX-License-Identifier: BSD-3-Clause
// Limits common to several programs; docs/reliability.md lists all limits.
#pragma once

#include <cstddef>

namespace halocline {

// Maximum number of vehicles of a scenario. Ten thousand of them, a square kilometre each, take 2.3 GB in one
// process (straight paths).
inline constexpr std::size_t kMaxVehicles = 16384;

}  // namespace halocline
