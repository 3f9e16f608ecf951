// SPDX-License-Identifier: BSD-3-Clause
// A netCDF-4 file that is being written, through netCDF's C library: for modules that have it.
//
// It is made in memory and written by close(): HDF5 reports a full disk, and crashes when the file is closed
// after that.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace halocline::clients {

// Functions throw std::runtime_error, with netCDF's own words.
class NetcdfOutput {
 public:
  enum class Type { kDouble, kInteger, kLong, kText };

  explicit NetcdfOutput(const std::string& path);
  ~NetcdfOutput();
  NetcdfOutput(const NetcdfOutput&) = delete;
  NetcdfOutput& operator=(const NetcdfOutput&) = delete;

  // Writes the file.
  void close();
  int dimension(const std::string& name, std::size_t size);
  int variable(const std::string& name, Type type, const std::vector<int>& dimensions);
  void attribute(int variable, const std::string& name, const std::string& value);
  void attribute(int variable, const std::string& name, double value);
  void attribute(const std::string& name, const std::string& value);  // of the file
  // Before any values: what stands for none, and that the variable is compressed.
  void fill_with_nan(int variable);
  // The whole variable; the last dimension varies fastest.
  void put(int variable, const std::vector<double>& values);
  void put(int variable, const std::vector<int>& values);
  void put(int variable, const std::vector<long long>& values);
  void put(int variable, const std::vector<const char*>& values);
  // Of a variable's first dimension the values at one index.
  void put_at(int variable, std::size_t index, const std::vector<std::size_t>& other_sizes,
              const std::vector<double>& values);

 private:
  void checked(int status) const;

  std::string path_;
  int id_ = -1;
};

}  // namespace halocline::clients
