// SPDX-License-Identifier: BSD-3-Clause
// Writer of a netCDF-4 file through netCDF's C library, for modules that link it.
//
// The file is built in memory and written by close(), because HDF5 crashes when a file is closed after an
// error from a full disk.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace halocline::clients {

// File being written. Functions throw std::runtime_error with netCDF's message.
class NetcdfOutput {
 public:
  enum class Type { kDouble, kInteger, kLong, kText };

  explicit NetcdfOutput(const std::string& path);
  ~NetcdfOutput();
  NetcdfOutput(const NetcdfOutput&) = delete;
  NetcdfOutput& operator=(const NetcdfOutput&) = delete;

  // Writes the file from memory to disk.
  void close();
  int dimension(const std::string& name, std::size_t size);
  int variable(const std::string& name, Type type, const std::vector<int>& dimensions);
  void attribute(int variable, const std::string& name, const std::string& value);
  void attribute(int variable, const std::string& name, double value);
  void attribute(const std::string& name, const std::string& value);  // attribute of the file
  // Sets NaN as the fill value and compresses the variable. To be called before any values are written.
  void fill_with_nan(int variable);
  // Write a whole variable; its last dimension varies fastest.
  void put(int variable, const std::vector<double>& values);
  void put(int variable, const std::vector<int>& values);
  void put(int variable, const std::vector<long long>& values);
  void put(int variable, const std::vector<const char*>& values);
  // Writes the values at one index of the variable's first dimension.
  void put_at(int variable, std::size_t index, const std::vector<std::size_t>& other_sizes,
              const std::vector<double>& values);

 private:
  void checked(int status) const;

  std::string path_;
  int id_ = -1;
};

}  // namespace halocline::clients
