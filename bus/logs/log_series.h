// SPDX-License-Identifier: BSD-3-Clause
// File names of a rotated log: run.lcm first, then run.0001.lcm, run.0002.lcm, ... in the same folder.
#pragma once

#include <string>
#include <vector>

namespace halocline::bus {

// Returns the file name of a part; part 0 is `path` itself.
std::string part_of_log(const std::string& path, int part);

// Returns the name of the first part, which may have been deleted; `path` itself if it is not a later part.
std::string first_part_of_log(const std::string& path);

// Returns all existing parts except the first, by number. Gaps are permitted, as the oldest may have been
// deleted.
std::vector<std::string> parts_of_log(const std::string& path);

}  // namespace halocline::bus
