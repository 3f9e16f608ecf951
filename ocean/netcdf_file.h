// SPDX-License-Identifier: BSD-3-Clause
// A netCDF file as readers of the sea see it: variables, their dimensions and attributes, values with packing
// undone. Part of the modules that read netCDF (halocline_ocean_fields.so, halocline_rasters.so).
//
// Values (CF 1.10, sections 2.5.1 and 8.1; NetCDF User Guide, appendix A), in this order:
// - _Unsigned = "true" turns negative integers into those above the half of their type;
// - missing is what equals _FillValue, any element of missing_value, or the type's default fill where no
//   _FillValue is given, all compared after rounding to the variable's type (1e20 as a double is no float);
//   what lies outside of valid_range, valid_min and valid_max; NaN; and what is beyond 1e30;
// - valid limits are of packed values, but of unpacked ones where their type is that of scale_factor and
//   wider than the data's;
// - the rest is multiplied by scale_factor, and add_offset added.
// Attributes may be text where numbers are meant ("-999"), and strings of netCDF-4.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace halocline::ocean {

class NetcdfFile {
 public:
  // Throws InvalidArgument when it is not whole (netcdf_header.h) or cannot be read as netCDF.
  explicit NetcdfFile(const std::string& path);
  ~NetcdfFile();
  NetcdfFile(const NetcdfFile&) = delete;
  NetcdfFile& operator=(const NetcdfFile&) = delete;

  std::vector<std::string> variables() const;
  bool has(const std::string& variable) const;
  // The names of its dimensions, outermost first, and their lengths.
  std::vector<std::string> dimensions_of(const std::string& variable) const;
  std::size_t length_of(const std::string& dimension) const;
  // Empty where there is none, or of another kind.
  std::string text(const std::string& variable, const char* attribute) const;
  std::vector<double> numbers(const std::string& variable, const char* attribute) const;
  // Those of a box of the variable: `counts` from `from` on along its dimensions, the last one fastest; NaN:
  // missing.
  std::vector<double> values(const std::string& variable, const std::vector<std::size_t>& from,
                             const std::vector<std::size_t>& counts) const;
  // All of them.
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
