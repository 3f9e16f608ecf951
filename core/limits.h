// SPDX-License-Identifier: BSD-3-Clause
// Limits that several programs share; docs/reliability.md has the table of all.
#pragma once

#include <cstddef>

namespace halocline {

// Vehicles of a scenario, and of a run.
inline constexpr std::size_t kMaxVehicles = 4096;

}  // namespace halocline
