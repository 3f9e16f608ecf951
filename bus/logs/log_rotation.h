// SPDX-License-Identifier: BSD-3-Clause
// `--log-rotate 256MB --log-rotate 1h --log-keep 48`: how the log of a run is cut into parts.
#pragma once

#include <string>
#include <vector>

#include "bus/logs/log_parts.h"

namespace halocline::clients {

// Each text is a size (kB, MB, GB: powers of 1000) or a simulated time (s, min, h). Throws InvalidArgument
// with what is allowed; also when parts are to be deleted of a log that is never cut.
bus::LogRotation rotation_of(const std::vector<std::string>& texts, int parts_kept);

}  // namespace halocline::clients
