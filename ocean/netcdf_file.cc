// SPDX-License-Identifier: BSD-3-Clause
#include "ocean/netcdf_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string_view>

#include <netcdf.h>

#include "core/check.h"
#include "core/csv_table.h"
#include "ocean/netcdf_header.h"

namespace halocline::ocean {
namespace {

constexpr double kBeyondAnyValue = 1e30;  // netCDF's own fill values of real numbers are 9.97e36
constexpr std::size_t kMaxRead = std::size_t{1} << 28;  // values at once: 2 GB
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Returns the fill value of a variable without the attribute; NaN: none, as for bytes.
double default_fill(nc_type type) {
  switch (type) {
    case NC_SHORT:
      return NC_FILL_SHORT;
    case NC_USHORT:
      return NC_FILL_USHORT;
    case NC_INT:
      return NC_FILL_INT;
    case NC_UINT:
      return NC_FILL_UINT;
    case NC_INT64:
      return static_cast<double>(NC_FILL_INT64);
    case NC_FLOAT:
    case NC_DOUBLE:
      return NC_FILL_DOUBLE;
    default:
      return std::nan("");
  }
}

int bits_of(nc_type type) {
  switch (type) {
    case NC_BYTE:
    case NC_UBYTE:
      return 8;
    case NC_SHORT:
    case NC_USHORT:
      return 16;
    case NC_INT:
    case NC_UINT:
    case NC_FLOAT:
      return 32;
    default:
      return 64;
  }
}

// Returns the value of the same bits as an unsigned integer, where `unsigned_bits` is not 0.
double without_sign(double value, int unsigned_bits) {
  return unsigned_bits > 0 && value < 0 ? std::ldexp(1.0, unsigned_bits) + value : value;
}

}  // namespace

// Interpretation of a variable's packed values, from its attributes.
struct NetcdfFile::Packing {
  std::vector<double> missing;
  double least = -kInfinity, greatest = kInfinity;
  bool limits_unpacked = false;
  double scale = 1, offset = 0;
  int unsigned_bits = 0;

  bool is_outside(double value) const { return value < least || value > greatest; }
  double unpacked(double raw) const {
    const double packed = without_sign(raw, unsigned_bits);
    const bool is_missing = std::find(missing.begin(), missing.end(), packed) != missing.end() ||
                            !(std::abs(packed) < kBeyondAnyValue);
    if (is_missing || (!limits_unpacked && is_outside(packed))) return std::nan("");
    const double value = packed * scale + offset;
    return limits_unpacked && is_outside(value) ? std::nan("") : value;
  }
};

NetcdfFile::NetcdfFile(const std::string& path) : path_(path) {
  require_whole_netcdf(path);
  // An absolute path is passed because netCDF takes "http:..." for the address of a server.
  const int status = nc_open(std::filesystem::absolute(path).c_str(), NC_NOWRITE, &id_);
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

int NetcdfFile::type_of(const std::string& variable) const {
  nc_type type = NC_NAT;
  require_good(nc_inq_vartype(id_, id_of(variable), &type), variable);
  return type;
}

std::optional<int> NetcdfFile::attribute_type(const std::string& variable, const char* attribute) const {
  nc_type type = NC_NAT;
  if (nc_inq_atttype(id_, id_of(variable), attribute, &type) != NC_NOERR) return std::nullopt;
  return type;
}

bool NetcdfFile::has(const std::string& variable) const {
  int id = 0;
  return nc_inq_varid(id_, variable.c_str(), &id) == NC_NOERR;
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
  const std::optional<int> type = attribute_type(variable, attribute);
  if (!type || (*type != NC_CHAR && *type != NC_STRING)) return {};
  require_good(nc_inq_attlen(id_, id_of(variable), attribute, &length), variable);
  std::string value;
  if (*type == NC_CHAR) {
    value.resize(length);
    require_good(nc_get_att_text(id_, id_of(variable), attribute, value.data()), variable);
  } else if (length > 0) {
    std::vector<char*> strings(length);
    require_good(nc_get_att_string(id_, id_of(variable), attribute, strings.data()), variable);
    if (strings[0] != nullptr) value = strings[0];
    nc_free_string(length, strings.data());
  }
  const auto is_filling = [](char c) {
    return c == '\0' || std::isspace(static_cast<unsigned char>(c)) != 0;
  };
  while (!value.empty() && is_filling(value.back())) value.pop_back();
  return value;
}

std::vector<double> NetcdfFile::numbers(const std::string& variable, const char* attribute) const {
  const std::optional<int> type = attribute_type(variable, attribute);
  if (!type) return {};
  if (*type == NC_CHAR || *type == NC_STRING) {
    const std::optional<double> number = parse_number(text(variable, attribute));
    return number ? std::vector{*number} : std::vector<double>{};
  }
  std::size_t length = 0;
  require_good(nc_inq_attlen(id_, id_of(variable), attribute, &length), variable);
  std::vector<double> values(length);
  require_good(nc_get_att_double(id_, id_of(variable), attribute, values.data()), variable);
  return values;
}

std::vector<double> NetcdfFile::values(const std::string& variable) const {
  std::vector<std::size_t> counts;
  for (const std::string& dimension : dimensions_of(variable)) counts.push_back(length_of(dimension));
  return values(variable, std::vector<std::size_t>(counts.size(), 0), counts);
}

std::vector<double> NetcdfFile::values(const std::string& variable, const std::vector<std::size_t>& from,
                                       const std::vector<std::size_t>& counts) const {
  std::size_t total = 1;
  for (const std::size_t count : counts) {
    if (count > kMaxRead / std::max<std::size_t>(total, 1))
      refuse(variable, "has more than " + std::to_string(kMaxRead) + " values to be read at once");
    total *= count;
  }
  std::vector<double> values(total);
  require_good(nc_get_vara_double(id_, id_of(variable), from.data(), counts.data(), values.data()), variable);

  const Packing packing = packing_of(variable);
  for (double& value : values) value = packing.unpacked(value);
  return values;
}

NetcdfFile::Packing NetcdfFile::packing_of(const std::string& variable) const {
  const nc_type type = type_of(variable);
  Packing packing;
  const auto first = [&](const char* attribute, double otherwise) {
    const std::vector<double> found = numbers(variable, attribute);
    return found.empty() ? otherwise : found.front();
  };
  const bool is_integer = type != NC_FLOAT && type != NC_DOUBLE;
  if (is_integer && text(variable, "_Unsigned") == "true") packing.unsigned_bits = bits_of(type);
  const auto as_stored = [&](double value) {
    return type == NC_FLOAT ? double{static_cast<float>(value)} : without_sign(value, packing.unsigned_bits);
  };
  packing.missing = {as_stored(first("_FillValue", default_fill(type)))};
  for (const double mark : numbers(variable, "missing_value")) packing.missing.push_back(as_stored(mark));
  packing.scale = first("scale_factor", 1);
  packing.offset = first("add_offset", 0);
  set_limits(variable, packing);
  return packing;
}

void NetcdfFile::set_limits(const std::string& variable, Packing& packing) const {
  for (const char* name : {"valid_range", "valid_min", "valid_max"}) {
    const std::vector<double> limits = numbers(variable, name);
    const bool is_range = limits.size() == 2;
    if (limits.empty() || (!is_range && std::string_view(name) == "valid_range")) continue;
    const nc_type type = type_of(variable), limit_type = *attribute_type(variable, name);
    packing.limits_unpacked = limit_type != type && bits_of(limit_type) >= bits_of(type) &&
                              attribute_type(variable, "scale_factor") == limit_type;
    const int bits = packing.limits_unpacked ? 0 : packing.unsigned_bits;
    if (std::string_view(name) != "valid_max") packing.least = without_sign(limits.front(), bits);
    if (std::string_view(name) != "valid_min") packing.greatest = without_sign(limits.back(), bits);
    if (is_range) return;
  }
}

}  // namespace halocline::ocean
