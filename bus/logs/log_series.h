// SPDX-License-Identifier: BSD-3-Clause
// Names of the files of a log that is rotated: run.lcm first, then run.0001.lcm, run.0002.lcm, ... beside it.
#pragma once

#include <string>
#include <vector>

namespace halocline::bus {

// `part` 0 is `path` itself.
std::string part_of_log(const std::string& path, int part);

// The name of the first part, `path` itself where it is no later one; that part may have been deleted.
std::string first_part_of_log(const std::string& path);

// All parts but the first that are there, by number. Gaps do not matter: the oldest may have been deleted.
std::vector<std::string> parts_of_log(const std::string& path);

}  // namespace halocline::bus
