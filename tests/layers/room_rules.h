// SPDX-License-Identifier: BSD-3-Clause
// The rooms of the tree, what each may include, and why: docs/architecture.md as data.
//
// A room is a folder with sources; a sub-folder is a room of its own. Debian puts LCM's headers where every
// compiler finds them, so lists of linked libraries alone do not keep LCM out of the models. Only `#include`
// lines are examined; a header reached through another is that other's business.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tests/layers/source_tree.h"

namespace halocline::layers {

// What a pure file uses of a clock, a file, the console or the environment through a header that it may
// include; empty when nothing, or when `file` is not pure.
std::string impure_name(std::string_view file, std::string_view source);

// Why `file` (from the root, "acoustics/sea/noise.cc") may not include `path`; empty when it may.
std::string objection(std::string_view file, std::string_view path);

// Every breach: "file:line: includes path: reason".
std::vector<std::string> breaches(const std::vector<SourceFile>& sources);

// Rooms that include each other in a circle, "a -> b -> a", of paths cut after `depth` elements; empty when
// there is none.
std::string room_cycle(const std::vector<SourceFile>& sources, int depth);

}  // namespace halocline::layers
