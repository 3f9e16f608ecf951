// SPDX-License-Identifier: BSD-3-Clause
#include "tests/layers/size_rules.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <sstream>
#include <string_view>
#include <vector>

#include "tests/layers/source_tree.h"

namespace halocline::layers {
namespace {

// The class of a member function that the line starts to define, "Outer::Inner" of "int Outer::Inner::size()
// const {"; empty when it defines none.
std::string class_defined_by(std::string_view line) {
  if (line.empty() || std::isalpha(static_cast<unsigned char>(line.front())) == 0) return "";
  std::string_view head = line.substr(0, line.find('('));
  if (head.size() == line.size() || head.find('=') < head.find("operator")) return "";
  head = head.substr(
      0, head.find("::operator") == std::string_view::npos ? head.size() : head.find("::operator") + 3);
  const std::size_t start = head.find_last_of(" *&");
  const std::string_view name = start == std::string_view::npos ? head : head.substr(start + 1);
  const std::size_t end = name.rfind("::");
  if (end == std::string_view::npos || std::isupper(static_cast<unsigned char>(name.front())) == 0) return "";
  return std::string(name.substr(0, end));
}

bool declares(const std::string& text, const std::string& name) {
  const std::string outer = name.substr(0, name.find("::"));
  for (const char* kind : {"class ", "struct "}) {
    const std::size_t at = text.find(kind + outer);
    const std::size_t end = at + std::string_view(kind).size() + outer.size();
    if (at != std::string::npos && end < text.size() &&
        text.find_first_of(";{", end) == text.find('{', end)) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::vector<std::string> long_files(const std::vector<SourceFile>& sources) {
  std::vector<std::string> found;
  for (const SourceFile& source : sources) {
    const int licence = source.text.starts_with("// SPDX-License-Identifier:") ? 1 : 0;
    const auto lines = std::count(source.text.begin(), source.text.end(), '\n') - licence;
    const int limit = source.path.ends_with(".cc") ? kMaxSourceLines : kMaxHeaderLines;
    if (lines > limit) {
      found.push_back(source.path + ": " + std::to_string(lines) + " lines, at most " +
                      std::to_string(limit));
    }
  }
  return found;
}

std::vector<std::string> full_folders(const std::vector<SourceFile>& sources) {
  std::map<std::string, int> counts;
  for (const SourceFile& source : sources) ++counts[std::string(folder_of(source.path))];
  std::vector<std::string> found;
  for (const auto& [folder, count] : counts) {
    if (count > kMaxFilesOfAFolder) {
      found.push_back(folder + ": " + std::to_string(count) + " source files, at most " +
                      std::to_string(kMaxFilesOfAFolder));
    }
  }
  return found;
}

std::vector<std::string> folders_without_readme(const std::vector<SourceFile>& sources,
                                                const std::vector<std::string>& paths) {
  std::set<std::string_view> folders;
  for (const SourceFile& source : sources) {
    if (!source.path.starts_with("tests/") && !source.path.starts_with("bench/"))
      folders.insert(folder_of(source.path));
  }
  for (const std::string& path : paths) {
    if (path.ends_with("/README.md")) folders.erase(folder_of(path));
  }
  std::vector<std::string> found;
  for (const std::string_view folder : folders) found.push_back(std::string(folder) + ": no README.md");
  return found;
}

std::vector<std::string> split_classes(const std::vector<SourceFile>& sources) {
  std::map<std::string, std::set<std::string>> files_of;  // by top folder and class
  for (const SourceFile& source : sources) {
    if (!source.path.ends_with(".cc")) continue;
    const std::string text = without_comments(source.text);
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      const std::string name = class_defined_by(line);
      if (name.empty() || declares(text, name)) continue;
      files_of[source.path.substr(0, source.path.find('/') + 1) + name].insert(source.path);
    }
  }
  std::vector<std::string> found;
  for (const auto& [name, files] : files_of) {
    if (files.size() < 2) continue;
    std::string text = name.substr(name.find('/') + 1) + ":";
    for (const std::string& file : files) text += (text.back() == ':' ? " " : ", ") + file;
    found.push_back(text);
  }
  return found;
}

}  // namespace halocline::layers
