// SPDX-License-Identifier: BSD-3-Clause
#include "tests/layers/name_rules.h"

#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace halocline::layers {
namespace {

using Places = std::map<std::string, std::set<std::string>>;  // paths of each name

std::vector<std::string> shared(const Places& places) {
  std::vector<std::string> found;
  for (const auto& [name, paths] : places) {
    if (paths.size() < 2) continue;
    std::string text = name + ":";
    for (const std::string& path : paths) text += (text.back() == ':' ? " " : ", ") + path;
    found.push_back(text);
  }
  return found;
}

bool is_header(const SourceFile& source) { return source.path.ends_with(".h"); }

}  // namespace

std::vector<std::string> shared_header_names(const std::vector<SourceFile>& sources) {
  Places places;
  for (const SourceFile& source : sources) {
    if (is_header(source)) places[source.path.substr(source.path.rfind('/') + 1)].insert(source.path);
  }
  return shared(places);
}

// Namespaces are not indented, so a definition at namespace scope starts its line.
std::vector<std::string> shared_type_names(const std::vector<SourceFile>& sources) {
  static const std::regex kDefinition(
      R"(^(?:(?:class|struct|enum class|enum) (\w+)\b(?!::)[^;]*$|using (\w+) =))");
  Places places;
  for (const SourceFile& source : sources) {
    if (!is_header(source)) continue;
    std::istringstream lines(without_comments(source.text));
    for (std::string line; std::getline(lines, line);) {
      std::smatch found;
      if (std::regex_search(line, found, kDefinition))
        places[found[1].matched ? found.str(1) : found.str(2)].insert(source.path);
    }
  }
  return shared(places);
}

}  // namespace halocline::layers
