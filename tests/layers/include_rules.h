// Who may include whom: the rules of docs/architecture.md as data, and what checks a source tree against
// them.
//
// Debian puts LCM's headers where every compiler finds them, so lists of linked libraries alone do not keep
// LCM out of the models. Only `#include` lines are looked at, comments aside; a header reached through
// another is that other's business.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace halocline::layers {

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

// What a pure file uses of a clock, a file, the console or the environment through a header that it may include;
// empty when nothing, or when `file` is not pure.
std::string impure_name(std::string_view file, std::string_view source);

// Why `file` (from the root, "acoustics/sea/noise.cc") may not include `path`; empty when it may.
std::string objection(std::string_view file, std::string_view path);

// A source file by its path from the root.
struct SourceFile {
  std::string path;
  std::string text;
};

// Every C++ file under the folders of ours below `root`, in order.
std::vector<SourceFile> sources_below(const std::string& root);

// Every breach: "file:line: includes path: reason".
std::vector<std::string> breaches(const std::vector<SourceFile>& sources);

// Folders that include each other in a circle, "a -> b -> a"; empty when there is none.
std::string folder_cycle(const std::vector<SourceFile>& sources);

}  // namespace halocline::layers
