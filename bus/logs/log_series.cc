// SPDX-License-Identifier: BSD-3-Clause
#include "bus/logs/log_series.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

namespace halocline::bus {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kDigits = 4;  // minimum; names of later parts are longer

// Returns the number between `stem` and `extension` in a part's name; 0 if it is not a part.
int part_number(const std::string& name, const std::string& stem, const std::string& extension) {
  const std::size_t around = stem.size() + 1 + extension.size();
  if (name.size() < around + kDigits || name.size() > around + 9) return 0;
  if (!name.starts_with(stem + ".") || !name.ends_with(extension)) return 0;
  const std::string digits = name.substr(stem.size() + 1, name.size() - around);
  if (digits.find_first_not_of("0123456789") != std::string::npos) return 0;
  return std::stoi(digits);
}

}  // namespace

std::string part_of_log(const std::string& path, int part) {
  if (part == 0) return path;
  char number[16];
  std::snprintf(number, sizeof number, ".%04d", part);
  const fs::path whole(path);
  return (whole.parent_path() / (whole.stem().string() + number + whole.extension().string())).string();
}

std::string first_part_of_log(const std::string& path) {
  const fs::path part(path),
      first = part.parent_path() / (part.stem().stem().string() + part.extension().string());
  const int number = part_number(part.filename().string(), first.stem().string(), part.extension().string());
  return number > 0 ? first.string() : path;
}

std::vector<std::string> parts_of_log(const std::string& path) {
  const fs::path whole(path);
  const fs::path folder = whole.has_parent_path() ? whole.parent_path() : fs::path(".");
  std::vector<int> numbers;
  std::error_code no_folder;
  for (const auto& entry : fs::directory_iterator(folder, no_folder)) {
    const int number =
        part_number(entry.path().filename().string(), whole.stem().string(), whole.extension().string());
    if (number > 0) numbers.push_back(number);
  }
  std::sort(numbers.begin(), numbers.end());
  std::vector<std::string> parts;
  for (const int number : numbers) parts.push_back(part_of_log(path, number));
  return parts;
}

}  // namespace halocline::bus
