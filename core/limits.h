// SPDX-License-Identifier: BSD-3-Clause
// Limits that several programs share; docs/reliability.md has the table of all.
#pragma once

#include <cstddef>

namespace halocline {

// Vehicles of a scenario. Ten thousand of them, a square kilometre each, take 2.3 GB in one process (straight
// paths).
inline constexpr std::size_t kMaxVehicles = 16384;

}  // namespace halocline
