// SPDX-License-Identifier: BSD-3-Clause
// Reader of a netCDF file: its variables, their dimensions and attributes, and their unpacked values. Part of
// the modules that read netCDF (halocline_ocean_fields.so, halocline_rasters.so).
//
// Values are interpreted in this order (CF 1.10, sections 2.5.1 and 8.1; NetCDF User Guide, appendix A):
// - _Unsigned = "true" turns negative integers into unsigned ones, above half the range of their type.
// - Missing values are those equal to _FillValue, to any element of missing_value, or, without _FillValue, to
//   the default fill value of the type, all compared after rounding to the variable's type (1e20 as a double
//   is not a float); values outside of valid_range, valid_min and valid_max; NaN; and magnitudes of 1e30 or
//   more.
// - Valid limits refer to packed values, but to unpacked ones where their type is that of scale_factor and at
//   least as wide as that of the data.
// - All other values are multiplied by scale_factor, and add_offset is added.
//
// Numeric attributes may be text ("-999") and netCDF-4 strings.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace halocline::ocean {

class NetcdfFile {
 public:
  // Throws InvalidArgument when the file is incomplete (netcdf_header.h) or cannot be read as netCDF.
  explicit NetcdfFile(const std::string& path);
  ~NetcdfFile();
  NetcdfFile(const NetcdfFile&) = delete;
  NetcdfFile& operator=(const NetcdfFile&) = delete;

  std::vector<std::string> variables() const;
  bool has(const std::string& variable) const;
  // Returns the names of the variable's dimensions, outermost first.
  std::vector<std::string> dimensions_of(const std::string& variable) const;
  std::size_t length_of(const std::string& dimension) const;
  // Returns an attribute; empty when there is none, or one of another type.
  std::string text(const std::string& variable, const char* attribute) const;
  std::vector<double> numbers(const std::string& variable, const char* attribute) const;
  // Returns the values of a box of the variable: `counts` values from index `from` on along each dimension,
  // the last dimension varying fastest; NaN: missing.
  std::vector<double> values(const std::string& variable, const std::vector<std::size_t>& from,
                             const std::vector<std::size_t>& counts) const;
  std::vector<double> values(const std::string& variable) const;

  // Throws InvalidArgument: "<path>: <variable>: <what>".
  [[noreturn]] void refuse(const std::string& variable, const std::string& what) const;
  const std::string& path() const { return path_; }

 private:
  int id_of(const std::string& variable) const;
  int type_of(const std::string& variable) const;
  std::optional<int> attribute_type(const std::string& variable, const char* attribute) const;
  struct Packing;
  Packing packing_of(const std::string& variable) const;
  void set_limits(const std::string& variable, Packing& packing) const;
  void require_good(int status, const std::string& variable) const;

  std::string path_;
  int id_ = -1;
};

}  // namespace halocline::ocean
