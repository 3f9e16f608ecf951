// SPDX-License-Identifier: BSD-3-Clause
// The files of the repository, its C++ sources as text, and their include directives.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace halocline::layers {

// A source file by its path from the root.
struct SourceFile {
  std::string path;
  std::string text;
};

// Paths of all files below `root` that git knows or would add, relative to it. Empty outside a git
// repository.
std::vector<std::string> files_below(const std::string& root);

// The C++ files among them, sorted by path.
std::vector<SourceFile> sources_below(const std::string& root);

// The folder of a path, "acoustics/sea" of "acoustics/sea/noise.cc"; empty when it has none.
std::string_view folder_of(std::string_view path);

// One `#include` of a file: the path between quotes or brackets. A path that cannot be read (a macro's name)
// is kept as written.
struct Include {
  int line = 0;  // from 1
  std::string path;
};

// All includes of a C++ source, those in comments left out.
std::vector<Include> includes_of(std::string_view source);

// The source with each comment turned into a space; line ends are kept.
std::string without_comments(std::string_view source);

}  // namespace halocline::layers
