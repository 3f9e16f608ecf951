// SPDX-License-Identifier: BSD-3-Clause
#include "ocean/netcdf_file.h"

#include <cmath>
#include <limits>

#include <netcdf.h>

#include "core/check.h"

namespace halocline::ocean {
namespace {

constexpr double kBeyondAnyValue = 1e30;  // netCDF's own fill values of real numbers are 9.97e36

// The fill value that a variable has without an attribute; NaN: none, as of bytes.
double default_fill(nc_type type) {
  switch (type) {
    case NC_SHORT:
      return NC_FILL_SHORT;
    case NC_INT:
      return NC_FILL_INT;
    case NC_FLOAT:
    case NC_DOUBLE:
      return NC_FILL_DOUBLE;
    default:
      return std::nan("");
  }
}

}  // namespace

NetcdfFile::NetcdfFile(const std::string& path) : path_(path) {
  const int status = nc_open(path.c_str(), NC_NOWRITE, &id_);
  require(status == NC_NOERR, path + ": cannot be read as netCDF: " + nc_strerror(status));
}

NetcdfFile::~NetcdfFile() { nc_close(id_); }

void NetcdfFile::refuse(const std::string& variable, const std::string& what) const {
  throw InvalidArgument(path_ + ": " + variable + ": " + what);
}

void NetcdfFile::require_good(int status, const std::string& variable) const {
  if (status != NC_NOERR) refuse(variable, std::string("cannot be read: ") + nc_strerror(status));
}

int NetcdfFile::id_of(const std::string& variable) const {
  int id = 0;
  require_good(nc_inq_varid(id_, variable.c_str(), &id), variable);
  return id;
}

std::vector<std::string> NetcdfFile::variables() const {
  int count = 0;
  require_good(nc_inq_nvars(id_, &count), "variables");
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i) {
    char name[NC_MAX_NAME + 1];
    require_good(nc_inq_varname(id_, i, name), "variables");
    names.emplace_back(name);
  }
  return names;
}

std::vector<std::string> NetcdfFile::dimensions_of(const std::string& variable) const {
  int count = 0, ids[NC_MAX_VAR_DIMS];
  require_good(nc_inq_var(id_, id_of(variable), nullptr, nullptr, &count, ids, nullptr), variable);
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i) {
    char name[NC_MAX_NAME + 1];
    require_good(nc_inq_dimname(id_, ids[i], name), variable);
    names.emplace_back(name);
  }
  return names;
}

std::size_t NetcdfFile::length_of(const std::string& dimension) const {
  int id = 0;
  std::size_t length = 0;
  require_good(nc_inq_dimid(id_, dimension.c_str(), &id), dimension);
  require_good(nc_inq_dimlen(id_, id, &length), dimension);
  return length;
}

std::string NetcdfFile::text(const std::string& variable, const char* attribute) const {
  std::size_t length = 0;
  nc_type type = NC_NAT;
  if (nc_inq_att(id_, id_of(variable), attribute, &type, &length) != NC_NOERR || type != NC_CHAR) return {};
  std::string value(length, '\0');
  require_good(nc_get_att_text(id_, id_of(variable), attribute, value.data()), variable);
  while (!value.empty() && value.back() == '\0') value.pop_back();
  return value;
}

std::vector<double> NetcdfFile::numbers(const std::string& variable, const char* attribute) const {
  std::size_t length = 0;
  nc_type type = NC_NAT;
  const int status = nc_inq_att(id_, id_of(variable), attribute, &type, &length);
  if (status != NC_NOERR || type == NC_CHAR || type == NC_STRING) return {};
  std::vector<double> values(length);
  require_good(nc_get_att_double(id_, id_of(variable), attribute, values.data()), variable);
  return values;
}

// CF 1.10, sections 2.5.1 and 8.1: what is missing, and what is valid, is said of the packed values, which are then
// multiplied by scale_factor, and add_offset added.
std::vector<double> NetcdfFile::values(const std::string& variable, std::size_t from,
                                       std::size_t count) const {
  const std::vector<std::string> dimensions = dimensions_of(variable);
  std::vector<std::size_t> start(dimensions.size(), 0), counts;
  std::size_t total = 1;
  for (const std::string& dimension : dimensions) {
    counts.push_back(counts.empty() ? count : length_of(dimension));
    total *= counts.back();
  }
  start.front() = from;
  std::vector<double> values(total);
  require_good(nc_get_vara_double(id_, id_of(variable), start.data(), counts.data(), values.data()),
               variable);

  const auto first = [&](const char* attribute, double otherwise) {
    const std::vector<double> found = numbers(variable, attribute);
    return found.empty() ? otherwise : found.front();
  };
  nc_type type = NC_NAT;
  require_good(nc_inq_vartype(id_, id_of(variable), &type), variable);
  const double fill = first("_FillValue", default_fill(type)), missing = first("missing_value", fill);
  const std::vector<double> range = numbers(variable, "valid_range");
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const double least = range.size() == 2 ? range[0] : first("valid_min", -kNone);
  const double greatest = range.size() == 2 ? range[1] : first("valid_max", kNone);
  const double scale = first("scale_factor", 1), offset = first("add_offset", 0);
  for (double& value : values) {
    const bool is_missing = value == fill || value == missing || value < least || value > greatest ||
                            !(std::abs(value) < kBeyondAnyValue);
    value = is_missing ? std::nan("") : value * scale + offset;
  }
  return values;
}

}  // namespace halocline::ocean
