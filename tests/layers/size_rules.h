// SPDX-License-Identifier: BSD-3-Clause
// Rules that keep a room surveyable: lengths of files, files of a folder, a README.md in each folder, one
// source file for a class.
#pragma once

#include <string>
#include <vector>

#include "tests/layers/source_tree.h"

namespace halocline::layers {

inline constexpr int kMaxSourceLines = 450;  // of a .cc
inline constexpr int kMaxHeaderLines = 250;
inline constexpr int kMaxFilesOfAFolder = 35;

// Files longer than their limit, without the line of the licence: "path: 472 lines, at most 450". Tests are
// held to the same limits.
std::vector<std::string> long_files(const std::vector<SourceFile>& sources);

// Folders with too many files: "path: 37 source files, at most 35".
std::vector<std::string> full_folders(const std::vector<SourceFile>& sources);

// Folders that hold sources and no README.md, those of tests and benchmarks left out: "path: no README.md".
// `paths` are all files of the tree.
std::vector<std::string> folders_without_readme(const std::vector<SourceFile>& sources,
                                                const std::vector<std::string>& paths);

// Classes whose members are defined in several source files: "Class: a.cc, b.cc". Approximate: a definition
// is a line that starts with "... Class::member("; classes that a source file declares itself are local to
// it.
std::vector<std::string> split_classes(const std::vector<SourceFile>& sources);

}  // namespace halocline::layers
