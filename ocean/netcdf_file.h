// SPDX-License-Identifier: BSD-3-Clause
// A netCDF file as the reader of ocean fields sees it: variables, their axes and attributes, values with packing undone. Part of
// the module halocline_ocean_fields.so.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace halocline::ocean {

class NetcdfFile {
 public:
  // Throws InvalidArgument when it cannot be read as netCDF.
  explicit NetcdfFile(const std::string& path);
  ~NetcdfFile();
  NetcdfFile(const NetcdfFile&) = delete;
  NetcdfFile& operator=(const NetcdfFile&) = delete;

  std::vector<std::string> variables() const;
  // The names of its dimensions, outermost first, and their lengths.
  std::vector<std::string> dimensions_of(const std::string& variable) const;
  std::size_t length_of(const std::string& dimension) const;
  // Empty where there is none, or of another kind.
  std::string text(const std::string& variable, const char* attribute) const;
  std::vector<double> numbers(const std::string& variable, const char* attribute) const;
  // `count` values from place `from` on along the first axis, all along the others; NaN: missing.
  std::vector<double> values(const std::string& variable, std::size_t from, std::size_t count) const;

  // Throws InvalidArgument: "<path>: <variable>: <what>".
  [[noreturn]] void refuse(const std::string& variable, const std::string& what) const;
  const std::string& path() const { return path_; }

 private:
  int id_of(const std::string& variable) const;
  void require_good(int status, const std::string& variable) const;

  std::string path_;
  int id_ = -1;
};

}  // namespace halocline::ocean
