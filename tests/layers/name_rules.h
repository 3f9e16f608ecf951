// SPDX-License-Identifier: BSD-3-Clause
// Names that mean one thing in the whole tree: those of headers and of the types that they declare.
#pragma once

#include <string>
#include <vector>

#include "tests/layers/source_tree.h"

namespace halocline::layers {

// Headers that share a name: "frames.h: core/frames.h, vehicle_sim/frames.h".
std::vector<std::string> shared_header_names(const std::vector<SourceFile>& sources);

// Types at namespace scope that several headers define: "Range: a.h, b.h". A declaration without a body is no
// definition, and a type inside of another is named by both.
std::vector<std::string> shared_type_names(const std::vector<SourceFile>& sources);

}  // namespace halocline::layers
