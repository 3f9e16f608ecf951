// SPDX-License-Identifier: BSD-3-Clause
// How comments read: a comment opens with its subject, and no line is too long to be read beside another.
#pragma once

#include <string>
#include <vector>

#include "tests/layers/source_tree.h"

namespace halocline::layers {

inline constexpr std::size_t kMaxColumns = 110;
inline constexpr double kMaxBareShare = 0.03;  // of the comments

// "FILE:LINE: N columns" for each longer line.
std::vector<std::string> long_lines(const std::vector<SourceFile>& sources);

// Numbers of comments and of those that open with a bare genitive or relative ("Of ...", "Whether ...").
struct Openings {
  int own = 0, own_bare = 0;  // comments on lines of their own; lines that follow each other are one
  int trailing = 0, trailing_bare = 0;  // comments behind code
  std::vector<std::string> bare = {};   // "FILE:LINE: text"
};
Openings openings(const std::vector<SourceFile>& sources);

}  // namespace halocline::layers
