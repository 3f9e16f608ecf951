// SPDX-License-Identifier: BSD-3-Clause
// Parses `--log-rotate 256MB --log-rotate 1h --log-keep 48`: how the log of a run is divided into parts.
#pragma once

#include <string>
#include <vector>

#include "bus/logs/log_parts.h"

namespace halocline::clients {

// Each text is a size (kB, MB, GB: powers of 1000) or a simulated time (s, min, h). Throws InvalidArgument
// that states the permitted values, also when parts are to be deleted of a log that is never divided.
bus::LogRotation rotation_of(const std::vector<std::string>& texts, int parts_kept);

}  // namespace halocline::clients
