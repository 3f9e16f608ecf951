// SPDX-License-Identifier: BSD-3-Clause
// Functions whose results may depend on the processor: those of <cmath> that IEEE 754 does not round
// correctly, and what calls them (Eigen's rotations by an angle, Boost.Math).
#pragma once

#include <string>
#include <vector>

#include "tests/layers/source_tree.h"

namespace halocline::layers {

// Every use in files of ours that results depend on: "file:line: std::exp; core/elementary.h has its like".
std::vector<std::string> processor_dependent_calls(const std::vector<SourceFile>& sources);

}  // namespace halocline::layers
