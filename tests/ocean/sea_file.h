// SPDX-License-Identifier: BSD-3-Clause
// Small netCDF files of water with every freedom that CF leaves, for the tests of their reader.
#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <netcdf.h>
#include <unistd.h>

namespace halocline::ocean::testing {

inline void good(int status) {
  if (status != NC_NOERR) throw std::runtime_error(nc_strerror(status));
}

using Texts = std::vector<std::pair<std::string, std::string>>;

struct Coordinate {
  std::string name;
  std::vector<double> values;
  Texts attributes;
};

// Temperature (and salinity, 36) on the axes named, an hour apart, at depths to 4000 m about 43.2 N 7.3 E.
struct SeaFile {
  Coordinate time{"time", {0}, {{"units", "hours since 2024-01-01"}, {"standard_name", "time"}}};
  Coordinate depth{
      "depth", {0, 100, 1000, 4000}, {{"units", "m"}, {"positive", "down"}, {"standard_name", "depth"}}};
  Coordinate latitude{
      "latitude", {43.0, 43.2, 43.4}, {{"units", "degrees_north"}, {"standard_name", "latitude"}}};
  Coordinate longitude{
      "longitude", {7.1, 7.3, 7.5}, {{"units", "degrees_east"}, {"standard_name", "longitude"}}};
  std::vector<std::string> order{"time", "depth", "latitude", "longitude"};
  Texts temperature{{"standard_name", "sea_water_temperature"}, {"units", "degC"}};
  Texts salinity{{"standard_name", "sea_water_salinity"}, {"units", "1e-3"}};
  // Of the value of each coordinate, in the order time, depth, latitude, longitude.
  std::function<double(double, double, double, double)> degrees = [](double, double depth_m, double, double) {
    return 20 - depth_m / 1000;
  };
  double missing_value = 0;                      // of type double, if not 0
  bool strings = false;                          // attributes of type string, in netCDF-4
  std::vector<Coordinate> two_dimensional = {};  // on latitude, longitude

  void put(int file, int variable, const Texts& attributes) const {
    for (const auto& [name, text] : attributes) {
      const char* pointer = text.c_str();
      good(strings ? nc_put_att_string(file, variable, name.c_str(), 1, &pointer)
                   : nc_put_att_text(file, variable, name.c_str(), text.size(), pointer));
    }
  }

  std::string write(const std::string& name) const {
    const std::string path = ::testing::TempDir() + "sea-" + std::to_string(getpid()) + "-" + name + ".nc";
    int file = 0;
    good(nc_create(path.c_str(), NC_CLOBBER | (strings ? NC_NETCDF4 : 0), &file));
    const std::vector<const Coordinate*> axes{&time, &depth, &latitude, &longitude};
    std::vector<int> dimensions(4), ids(4), on, more;
    for (std::size_t i = 0; i < 4; ++i) {
      good(nc_def_dim(file, axes[i]->name.c_str(),
                      axes[i]->values.empty() ? NC_UNLIMITED : axes[i]->values.size(), &dimensions[i]));
      good(nc_def_var(file, axes[i]->name.c_str(), NC_DOUBLE, 1, &dimensions[i], &ids[i]));
      put(file, ids[i], axes[i]->attributes);
    }
    for (const std::string& axis : order) {
      for (std::size_t i = 0; i < 4; ++i) {
        if (axes[i]->name == axis) on.push_back(static_cast<int>(i));
      }
    }
    for (const Coordinate& one : two_dimensional) {
      const int plane[2]{dimensions[2], dimensions[3]};
      more.push_back(0);
      good(nc_def_var(file, one.name.c_str(), NC_DOUBLE, 2, plane, &more.back()));
      put(file, more.back(), one.attributes);
    }
    std::vector<int> on_dimensions;
    for (const int i : on) on_dimensions.push_back(dimensions[static_cast<std::size_t>(i)]);
    const auto define = [&](const char* variable, const Texts& attributes) {
      int id = 0;
      good(nc_def_var(file, variable, NC_FLOAT, static_cast<int>(on.size()), on_dimensions.data(), &id));
      put(file, id, attributes);
      if (missing_value != 0)
        good(nc_put_att_double(file, id, "missing_value", NC_DOUBLE, 1, &missing_value));
      return id;
    };
    const int t = define("t", temperature), s = define("s", salinity);
    good(nc_enddef(file));
    for (std::size_t i = 0; i < 4; ++i) {
      if (!axes[i]->values.empty()) good(nc_put_var_double(file, ids[i], axes[i]->values.data()));
    }
    for (std::size_t i = 0; i < more.size(); ++i)
      good(nc_put_var_double(file, more[i], two_dimensional[i].values.data()));
    std::vector<float> values;
    std::vector<std::size_t> at(on.size(), 0);
    for (bool is_done = time.values.empty(); !is_done;) {
      double place[4] = {};
      for (std::size_t d = 0; d < on.size(); ++d)
        place[on[d]] = axes[static_cast<std::size_t>(on[d])]->values[at[d]];
      values.push_back(static_cast<float>(degrees(place[0], place[1], place[2], place[3])));
      std::size_t d = on.size();
      while (d > 0 && ++at[d - 1] == axes[static_cast<std::size_t>(on[d - 1])]->values.size()) at[--d] = 0;
      is_done = d == 0;
    }
    std::vector<float> salt(values.size(), 36.F);
    for (std::size_t i = 0; i < salt.size(); ++i) salt[i] = values[i] > 1e10F ? values[i] : salt[i];
    if (!values.empty()) good(nc_put_var_float(file, t, values.data()));
    if (!values.empty()) good(nc_put_var_float(file, s, salt.data()));
    good(nc_close(file));
    return path;
  }
};

}  // namespace halocline::ocean::testing
