// SPDX-License-Identifier: BSD-3-Clause
#include "tests/layers/source_tree.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <sstream>
#include <string_view>
#include <vector>

namespace halocline::layers {
namespace {

const std::set<std::string> kExtensions{".h", ".hpp", ".cc", ".cpp", ".c", ".in"};

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front()))) text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.remove_suffix(1);
  return text;
}

bool take(std::string_view& text, std::string_view prefix) {
  text = trimmed(text);
  if (!text.starts_with(prefix)) return false;
  text = trimmed(text.substr(prefix.size()));
  return true;
}

// What an include directive names; empty when the line is none.
std::string included_in(std::string_view line) {
  const bool directive =
      (take(line, "#") || take(line, "%:")) && (take(line, "include") || take(line, "import"));
  if (!directive || line.empty()) return "";
  const char end = line[0] == '<' ? '>' : line[0];
  const std::size_t close = line.find(end, 1);
  if ((line[0] != '<' && line[0] != '"') || close == std::string_view::npos) return std::string(line);
  return std::string(line.substr(1, close - 1));
}

}  // namespace

std::string without_comments(std::string_view source) {
  std::string text;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const std::string_view rest = source.substr(i);
    if (rest.starts_with("//")) {
      const std::size_t end = std::min(source.find('\n', i), source.size());
      i = end - 1;
    } else if (rest.starts_with("/*")) {
      const std::size_t end = std::min(source.find("*/", i + 2), source.size() - 2) + 2;
      text += ' ';
      text.append(static_cast<std::size_t>(std::count(&source[i], &source[i] + (end - i), '\n')), '\n');
      i = end - 1;
    } else {
      text += source[i];
    }
  }
  return text;
}

std::vector<Include> includes_of(std::string_view source) {
  const std::string text = without_comments(source);
  std::vector<Include> includes;
  int line_number = 1;
  for (std::size_t start = 0; start < text.size();) {
    const int first_line = line_number;
    std::string line;
    bool continued = true;
    while (continued && start < text.size()) {
      const std::size_t end = std::min(text.find('\n', start), text.size());
      line += text.substr(start, end - start);
      continued = !line.empty() && line.back() == '\\';
      if (continued) line.back() = ' ';
      start = end + 1;
      ++line_number;
    }
    const std::string path = included_in(line);
    if (!path.empty()) includes.push_back({first_line, path});
  }
  return includes;
}

std::string_view folder_of(std::string_view path) {
  const std::size_t end = path.rfind('/');
  return end == std::string_view::npos ? "" : path.substr(0, end);
}

std::vector<std::string> files_below(const std::string& root) {
  const std::string command =
      "git -c safe.directory='*' -C '" + root + "' ls-files --cached --others --exclude-standard";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string listing;
  std::array<char, 4096> buffer{};
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe.get()))
    listing.append(buffer.data(), count);
  std::vector<std::string> paths;
  std::istringstream lines(listing);
  for (std::string line; std::getline(lines, line);) {
    if (std::filesystem::is_regular_file(std::filesystem::path(root) / line)) paths.push_back(line);
  }
  return paths;
}

std::vector<SourceFile> sources_below(const std::string& root) {
  std::vector<SourceFile> sources;
  for (const std::string& path : files_below(root)) {
    const std::filesystem::path file = std::filesystem::path(root) / path;
    if (kExtensions.contains(file.extension().string())) sources.push_back({path, text_of(file)});
  }
  std::sort(sources.begin(), sources.end(), [](const auto& a, const auto& b) { return a.path < b.path; });
  return sources;
}

}  // namespace halocline::layers
