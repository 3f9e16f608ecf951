// SPDX-License-Identifier: BSD-3-Clause
// An ocean field (netCDF) through our reader, and the water and current in it. The bytes say how the file
// departs from a good one: any bytes as a file would try netCDF, which asks for the memory that a header
// claims.
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <netcdf.h>

#include "core/check.h"
#include "core/frames.h"
#include "core/units.h"
#include "ocean/ocean_field.h"
#include "ocean/ocean_field_reader.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/scratch_file.h"

namespace halocline::fuzz {
namespace {

constexpr std::array<nc_type, 6> kTypes{NC_DOUBLE, NC_FLOAT, NC_SHORT, NC_INT, NC_BYTE, NC_CHAR};
constexpr std::array kAttributes{"units",         "calendar",  "positive",    "standard_name", "_FillValue",
                                 "missing_value", "valid_min", "valid_range", "scale_factor",  "add_offset"};

struct Axis {
  const char* name;
  std::vector<double> values;
  const char* units;
};
struct Variable {
  const char* name;
  const char* units;
  double value;
};

// What netCDF refuses is left out of the file.
class Maker {
 public:
  explicit Maker(Input& input) : input_(input) {}

  void make(const std::string& path) {
    if (nc_create(path.c_str(), NC_CLOBBER, &file_) != NC_NOERR) throw std::runtime_error("no scratch file");
    const std::array<Axis, 4> axes{{{"time", {0, 6}, "hours since 2026-05-01 00:00:00"},
                                    {"depth", {0, 50, 200}, "m"},
                                    {"lat", {-90, 0, 90}, "degrees_north"},
                                    {"lon", {-180, 0, 180}, "degrees_east"}}};
    for (const Axis& axis : axes) add(axis);
    for (const Variable& variable : {Variable{"water_u", "m/s", 0.2}, Variable{"water_v", "m/s", -0.1},
                                     Variable{"water_temp", "degC", 10}, Variable{"salinity", "psu", 35}})
      add(variable);
    nc_enddef(file_);
    for (std::size_t i = 0; i < ids_.size(); ++i) nc_put_var_double(file_, ids_[i], values_[i].data());
    nc_close(file_);
  }

 private:
  // The one given, but for one in eight: then another.
  std::string text(const char* usual) {
    return input_.below(8) == 7 ? std::string(input_.text_block()) : std::string(usual);
  }
  nc_type type() { return kTypes[input_.below(8) == 7 ? input_.below(kTypes.size()) : 0]; }
  double number() {
    constexpr std::array<double, 8> kOdd{0, -1, 1e-300, 1e30, 1e300, 360, 32'767, 9.96921e36};
    return input_.below(2) == 0 ? kOdd[input_.below(kOdd.size())] : input_.number<std::int16_t>() / 8.0;
  }

  void add(const Axis& axis) {
    const std::string name = text(axis.name);
    std::vector<double> values = axis.values;
    if (input_.below(8) == 7) {
      values.resize(1 + input_.below(5));
      for (double& value : values) value = number();
    }
    int dimension = 0;
    if (nc_def_dim(file_, name.c_str(), values.size(), &dimension) != NC_NOERR) return;
    dimensions_.push_back(dimension);
    lengths_.push_back(values.size());
    if (input_.below(16) == 15) return;
    define(name, std::span(&dimension, 1), axis.units, values);
  }

  void add(const Variable& variable) {
    if (input_.below(16) == 15) return;
    std::vector<int> on = dimensions_;
    std::size_t count = 1;
    for (const std::size_t length : lengths_) count *= length;
    if (input_.below(8) == 7 && !on.empty()) {
      on.erase(on.begin() + static_cast<std::ptrdiff_t>(input_.below(on.size())));
    } else if (input_.below(8) == 7 && !on.empty()) {
      std::rotate(on.begin(), on.begin() + static_cast<std::ptrdiff_t>(input_.below(on.size())), on.end());
    }
    std::vector<double> values(count, variable.value);
    for (std::size_t i = input_.below(8); i > 0; --i) values[input_.below(256) % count] = number();
    define(text(variable.name), on, variable.units, values);
  }

  void define(const std::string& name, std::span<const int> on, const char* units,
              std::vector<double> values) {
    int id = 0;
    if (nc_def_var(file_, name.c_str(), type(), static_cast<int>(on.size()), on.data(), &id) != NC_NOERR)
      return;
    const std::string unit = text(units);
    nc_put_att_text(file_, id, "units", unit.size(), unit.data());
    for (std::size_t i = input_.below(8) == 7 ? input_.below(4) : 0; i > 0; --i) {
      const char* attribute = kAttributes[input_.below(kAttributes.size())];
      if (input_.below(2) == 0) {
        const auto value = input_.text_block();
        nc_put_att_text(file_, id, attribute, value.size(), value.data());
      } else {
        const std::array<double, 2> two{number(), number()};
        nc_put_att_double(file_, id, attribute, type(), 1 + input_.below(2), two.data());
      }
    }
    ids_.push_back(id);
    values_.push_back(std::move(values));
  }

  Input& input_;
  int file_ = 0;
  std::vector<int> dimensions_, ids_;
  std::vector<std::size_t> lengths_;
  std::vector<std::vector<double>> values_;
};

}  // namespace
}  // namespace halocline::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace halocline;
  static fuzz::ScratchFile file(".nc");
  fuzz::Input input(data, size);
  ocean::FieldQuery query;
  query.start_date = input.text_block();
  query.origin = {to_radians(input.number<std::int8_t>()), to_radians(input.number<std::int8_t>())};
  query.path = file.path();
  fuzz::Maker(input).make(query.path);
  try {
    const auto field = ocean::read_ocean_field(query);
    const Vec3 place{1000, -2000, 30};
    if (field->has_current()) field->current_ned_mps(place, 600);
    if (field->has_water()) field->water_at(place, 600);
    field->crossings(Vec3::Zero(), place);
  } catch (const InvalidArgument&) {
  }
  return 0;
}
