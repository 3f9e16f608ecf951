// SPDX-License-Identifier: BSD-3-Clause
#include "runs/export/netcdf_output.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <stdexcept>

#include <netcdf.h>
#include <netcdf_mem.h>

namespace halocline::clients {
namespace {

nc_type to_netcdf(NetcdfOutput::Type type) {
  switch (type) {
    case NetcdfOutput::Type::kInteger:
      return NC_INT;
    case NetcdfOutput::Type::kLong:
      return NC_INT64;
    case NetcdfOutput::Type::kText:
      return NC_STRING;
    case NetcdfOutput::Type::kDouble:
      break;
  }
  return NC_DOUBLE;
}

constexpr std::size_t kFirstBytes = 1 << 20;  // initial size; netCDF enlarges it

struct Free {
  void operator()(void* memory) const { std::free(memory); }
};

}  // namespace

NetcdfOutput::NetcdfOutput(const std::string& path) : path_(path) {
  checked(nc_create_mem(path.c_str(), NC_NETCDF4, kFirstBytes, &id_));
}

NetcdfOutput::~NetcdfOutput() {
  if (id_ >= 0) nc_abort(id_);
}

void NetcdfOutput::close() {
  const int id = id_;
  id_ = -1;
  NC_memio image{};
  checked(nc_close_memio(id, &image));
  const std::unique_ptr<void, Free> memory(image.memory);
  std::ofstream file(path_, std::ios::binary);
  file.write(static_cast<const char*>(image.memory), static_cast<std::streamsize>(image.size));
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path_ + ": " + std::strerror(errno));
}

int NetcdfOutput::dimension(const std::string& name, std::size_t size) {
  int dimension = 0;
  checked(nc_def_dim(id_, name.c_str(), size, &dimension));
  return dimension;
}

int NetcdfOutput::variable(const std::string& name, Type type, const std::vector<int>& dimensions) {
  int variable = 0;
  checked(nc_def_var(id_, name.c_str(), to_netcdf(type), static_cast<int>(dimensions.size()),
                     dimensions.data(), &variable));
  return variable;
}

void NetcdfOutput::attribute(int variable, const std::string& name, const std::string& value) {
  checked(nc_put_att_text(id_, variable, name.c_str(), value.size(), value.data()));
}

void NetcdfOutput::attribute(int variable, const std::string& name, double value) {
  checked(nc_put_att_double(id_, variable, name.c_str(), NC_DOUBLE, 1, &value));
}

void NetcdfOutput::attribute(const std::string& name, const std::string& value) {
  attribute(NC_GLOBAL, name, value);
}

void NetcdfOutput::fill_with_nan(int variable) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  checked(nc_put_att_double(id_, variable, "_FillValue", NC_DOUBLE, 1, &none));
  checked(nc_def_var_deflate(id_, variable, /*shuffle=*/1, /*deflate=*/1, /*level=*/4));
}

void NetcdfOutput::put(int variable, const std::vector<double>& values) {
  checked(nc_put_var_double(id_, variable, values.data()));
}

void NetcdfOutput::put(int variable, const std::vector<int>& values) {
  checked(nc_put_var_int(id_, variable, values.data()));
}

void NetcdfOutput::put(int variable, const std::vector<long long>& values) {
  checked(nc_put_var_longlong(id_, variable, values.data()));
}

void NetcdfOutput::put(int variable, const std::vector<const char*>& values) {
  std::vector<const char*> texts = values;
  checked(nc_put_var_string(id_, variable, texts.data()));
}

void NetcdfOutput::put_at(int variable, std::size_t index, const std::vector<std::size_t>& other_sizes,
                          const std::vector<double>& values) {
  std::vector<std::size_t> first{index}, counts{1};
  for (const std::size_t size : other_sizes) {
    first.push_back(0);
    counts.push_back(size);
  }
  checked(nc_put_vara_double(id_, variable, first.data(), counts.data(), values.data()));
}

void NetcdfOutput::checked(int status) const {
  if (status != NC_NOERR) throw std::runtime_error("cannot write " + path_ + ": " + nc_strerror(status));
}

}  // namespace halocline::clients
