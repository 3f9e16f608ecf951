// SPDX-License-Identifier: BSD-3-Clause
#include "ocean/ocean_field_reader.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netcdf.h>
#include <unistd.h>

#include "core/check.h"
#include "core/frames.h"
#include "core/units.h"
#include "ocean/potential_temperature.h"
#include "tests/ocean/sea_file.h"
#include "tests/support/channel_file.h"
#include "tests/support/tolerance.h"

namespace halocline::ocean {
namespace {

using halocline::testing::tolerance;
using ocean::testing::good;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr GeodeticOrigin kOrigin{to_radians(40), to_radians(-50)};

// A file on 2 times, 3 depths, 2 rows and 2 columns, as HYCOM has it unless told otherwise.
struct FieldFile {
  std::vector<double> times{0, 6}, depths{0, 50, 200}, latitudes{39, 41}, longitudes{309, 311};
  std::string time_units = "hours since 2026-05-01 00:00:00", calendar = "gregorian", depth_units = "m",
              positive = "down";
  std::string temperature_name = "water_temp", temperature_standard_name, temperature_units = "degC";
  std::vector<std::string> order{"time", "depth", "lat", "lon"};
  bool has_salinity = true, has_current = true;
  short fill = -30'000;
  std::function<double(double, double, double, double)> temperature = [](double time, double depth,
                                                                         double latitude, double longitude) {
    return 10 + time / 6 - depth / 100 + (latitude - 40) + 0.5 * (longitude - 310);
  };
};

void put_text(int file, int variable, const char* name, const std::string& text) {
  if (!text.empty()) good(nc_put_att_text(file, variable, name, text.size(), text.c_str()));
}

std::string write(const FieldFile& f, const std::string& name) {
  const std::string path = ::testing::TempDir() + "ocean-" + std::to_string(getpid()) + "-" + name + ".nc";
  int file = 0;
  good(nc_create(path.c_str(), NC_CLOBBER, &file));
  const std::vector<std::string> names{"time", "depth", "lat", "lon"};
  const std::vector<const std::vector<double>*> axes{&f.times, &f.depths, &f.latitudes, &f.longitudes};
  const std::vector<std::string> units{f.time_units, f.depth_units, "degrees_north", "degrees_east"};
  int axis_ids[4], dimension_ids[4];
  for (int i = 0; i < 4; ++i) {
    good(nc_def_dim(file, names[i].c_str(), axes[i]->size(), &dimension_ids[i]));
    good(nc_def_var(file, names[i].c_str(), NC_DOUBLE, 1, &dimension_ids[i], &axis_ids[i]));
    put_text(file, axis_ids[i], "units", units[i]);
  }
  put_text(file, axis_ids[0], "calendar", f.calendar);
  put_text(file, axis_ids[1], "positive", f.positive);
  std::vector<int> on;
  for (const std::string& axis : f.order)
    on.push_back(dimension_ids[std::find(names.begin(), names.end(), axis) - names.begin()]);
  const double scale = 0.001, offset = 20;
  const auto define = [&](const std::string& variable, const std::string& unit,
                          const std::string& standard_name) {
    int id = 0;
    good(nc_def_var(file, variable.c_str(), NC_SHORT, static_cast<int>(on.size()), on.data(), &id));
    put_text(file, id, "units", unit);
    put_text(file, id, "standard_name", standard_name);
    good(nc_put_att_double(file, id, "scale_factor", NC_DOUBLE, 1, &scale));
    good(nc_put_att_double(file, id, "add_offset", NC_DOUBLE, 1, &offset));
    good(nc_put_att_short(file, id, "_FillValue", NC_SHORT, 1, &f.fill));
    return id;
  };
  const int temperature = define(f.temperature_name, f.temperature_units, f.temperature_standard_name);
  const int salinity = f.has_salinity ? define("salinity", "psu", "") : -1;
  const int east = f.has_current ? define("water_u", "m/s", "eastward_sea_water_velocity") : -1;
  const int north = f.has_current ? define("water_v", "m/s", "northward_sea_water_velocity") : -1;
  good(nc_enddef(file));
  for (int i = 0; i < 4; ++i) good(nc_put_var_double(file, axis_ids[i], axes[i]->data()));
  const auto packed = [&](double value) {
    return std::isnan(value) ? f.fill : static_cast<short>(std::lround((value - offset) / scale));
  };
  const auto put = [&](int id, const std::function<double(double, double, double, double)>& value) {
    if (id < 0) return;
    std::vector<short> values;
    for (const double time : f.times)
      for (const double depth : f.depths)
        for (const double latitude : f.latitudes)
          for (const double longitude : f.longitudes)
            values.push_back(packed(value(time, depth, latitude, longitude)));
    good(nc_put_var_short(file, id, values.data()));
  };
  if (f.order.size() == 4) {
    put(temperature, f.temperature);
    put(salinity, [](auto...) { return 35.0; });
    put(east, [](auto...) { return 0.25; });
    put(north, [](double, double depth, double, double) { return depth > 100 ? std::nan("") : -0.5; });
  }
  good(nc_close(file));
  return path;
}

std::string refusal(const FieldFile& file, const std::string& name, const std::string& start = "") {
  try {
    read_ocean_field({write(file, name), start, kOrigin});
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "taken";
}

TEST(OceanFieldReader, UnpacksAndTurnsAxesThatFall) {
  const FieldFile plain;
  FieldFile turned = plain;
  turned.depths = {200, 50, 0};
  turned.latitudes = {41, 39};
  FieldFile upward = plain;
  upward.depths = {-200, -50, 0};
  upward.positive = "up";
  upward.temperature = [&](double time, double height, double latitude, double longitude) {
    return plain.temperature(time, -height, latitude, longitude);
  };
  const std::vector<FieldFile> files{plain, turned, upward};
  for (std::size_t i = 0; i < files.size(); ++i) {
    const auto field = read_ocean_field({write(files[i], "axes-" + std::to_string(i)), "", kOrigin});
    EXPECT_EQ(field->grid().depths_m, (std::vector<double>{0, 50, 200}));
    const WaterAtDepth water = field->water_at({0, 0, 125}, 3 * 3600);
    // The place of the origin, in the middle of the grid; half way in time, and between two depths.
    EXPECT_NEAR(water.temperature_degc, 10 + 0.5 - 1.25, tolerance(1e-5)) << i;
    EXPECT_NEAR(water.salinity_psu, 35, tolerance(1e-5));
    const Vec3 current = field->current_ned_mps({0, 0, 200}, 0);  // the seabed has that of 50 m
    EXPECT_NEAR(current.x(), -0.5, tolerance(1e-6));
    EXPECT_NEAR(current.y(), 0.25, tolerance(1e-6));
  }
}

TEST(OceanFieldReader, StartsAtItsFirstTimeOrWhenTold) {
  const std::string path = write({}, "start");
  const double at_first = read_ocean_field({path, "", kOrigin})->water_at({0, 0, 0}, 0).temperature_degc;
  const double later =
      read_ocean_field({path, "2026-05-01T03:00:00Z", kOrigin})->water_at({0, 0, 0}, 0).temperature_degc;
  EXPECT_NEAR(later - at_first, 0.5, tolerance(1e-5));
  EXPECT_NE(
      refusal({}, "late", "2026-05-02")
          .find("time: the start is 2026-05-02; allowed is 2026-05-01T00:00:00Z to 2026-05-01T06:00:00Z"),
      std::string::npos);
}

TEST(OceanFieldReader, PotentialTemperatureBecomesInSitu) {
  FieldFile file;
  file.temperature_name = "thetao";
  file.temperature_standard_name = "sea_water_potential_temperature";
  file.depths = {0, 50, 4000};
  file.temperature = [](auto...) { return 2.0; };
  const auto field = read_ocean_field({write(file, "potential"), "", kOrigin});
  const double expected = in_situ_temperature_degc(35, 2, 4000, to_radians(40));
  EXPECT_GT(expected, 2.3);
  EXPECT_NEAR(field->water_at({0, 0, 4000}, 0).temperature_degc, expected, tolerance(1e-3));
}

TEST(OceanFieldReader, KelvinBecomesDegrees) {
  FieldFile file;
  file.temperature_units = "K";
  file.temperature = [](auto...) { return 20.0; };  // packed values reach up to 52 degrees
  EXPECT_NE(refusal(file, "kelvin").find("temperature is -253.15 degC"), std::string::npos);
}

TEST(OceanFieldReader, OneFieldIsReadOnce) {
  const std::string path = write({}, "once");
  const auto one = read_ocean_field({path, "", kOrigin}), other = read_ocean_field({path, "", kOrigin});
  EXPECT_EQ(one, other);
  EXPECT_NE(one, read_ocean_field({path, "2026-05-01T03:00:00Z", kOrigin}));
}

TEST(OceanFieldReader, NamesFileVariableAndWhatIsAllowed) {
  FieldFile file;
  file.order = {"time", "lat", "lon"};
  EXPECT_THAT(refusal(file, "surface"),
              AllOf(HasSubstr("its axes are time, latitude, longitude; allowed are time (or none), depth"),
                    HasSubstr("there is no axis of depth")));
  file = {};
  file.depth_units = "level";
  EXPECT_NE(refusal(file, "level").find("depth: units are \"level\"; allowed are m"), std::string::npos);
  file = {};
  file.temperature_units = "W";
  EXPECT_NE(refusal(file, "watt").find("water_temp: units are \"W\"; allowed are degC"), std::string::npos);
  file = {};
  file.calendar = "lunar";
  EXPECT_NE(refusal(file, "lunar").find("time: calendar is \"lunar\""), std::string::npos);
  file = {};
  file.depths = {0, 60, 50};
  EXPECT_NE(refusal(file, "unordered").find("depth: neither rises nor falls throughout, at 2"),
            std::string::npos);
  file = {};
  file.has_salinity = false;
  EXPECT_NE(refusal(file, "fresh").find("has temperature or salinity alone"), std::string::npos);
  file = {};
  file.temperature = [](auto...) { return 48.0; };
  EXPECT_NE(refusal(file, "hot").find("hot.nc: temperature is 48 degC; allowed is -5 to 45 degC"),
            std::string::npos);
  file = {};
  file.latitudes = {50, 52};
  EXPECT_NE(
      refusal(file, "elsewhere").find("latitude of the scenario's origin is 40 deg; allowed is 50 to 52 deg"),
      std::string::npos);
  EXPECT_THROW(read_ocean_field({"/nonexistent.nc", "", kOrigin}), InvalidArgument);
}

// A header may claim any size: that of a file of 4 kB is refused before memory is asked for.
TEST(OceanFieldReader, RefusesMoreValuesThanAFileCanHold) {
  const auto claimed = [](std::size_t longitudes, std::size_t depths) {
    const std::string path = ::testing::TempDir() + "claims.nc";
    int file = 0, ids[4], on[4];
    good(nc_create(path.c_str(), NC_CLOBBER | NC_NETCDF4, &file));
    const std::vector<std::pair<std::string, std::size_t>> axes{
        {"time", 1}, {"depth", depths}, {"lat", 500}, {"lon", longitudes}};
    const std::vector<std::string> units{"hours since 2026-05-01 00:00:00", "m", "degrees_north",
                                         "degrees_east"};
    for (int i = 0; i < 4; ++i) {
      good(nc_def_dim(file, axes[i].first.c_str(), axes[i].second, &ids[i]));
      good(nc_def_var(file, axes[i].first.c_str(), NC_DOUBLE, 1, &ids[i], &on[i]));
      good(nc_def_var_deflate(file, on[i], 1, 1, 1));
      put_text(file, on[i], "units", units[i]);
      if (i == 1) put_text(file, on[i], "positive", "down");
      if (axes[i].second > 1000) continue;
      std::vector<double> rising(axes[i].second);
      std::iota(rising.begin(), rising.end(), 0.0);
      good(nc_put_var_double(file, on[i], rising.data()));
    }
    for (const std::string name : {"water_u", "water_v"}) {
      int id = 0;
      good(nc_def_var(file, name.c_str(), NC_FLOAT, 4, ids, &id));
      good(nc_def_var_deflate(file, id, 1, 1, 1));
      put_text(file, id, "units", "m/s");
    }
    good(nc_close(file));
    try {
      read_ocean_field({path, "", kOrigin});
    } catch (const InvalidArgument& error) {
      return std::string(error.what());
    }
    return std::string("it was read");
  };
  EXPECT_THAT(claimed(4'000'000'000, 10), HasSubstr("lon: has 4000000000 values; allowed are 1000000"));
  EXPECT_THAT(claimed(1000, 100), HasSubstr("claims.nc: has 50000000 values a variable in "));
  EXPECT_THAT(claimed(1000, 100), HasSubstr("allowed are 100000000, and 300 a byte: cut out a region"));
  EXPECT_THAT(claimed(1000, 900), HasSubstr("claims.nc: has 450000000 values a variable in "));
}

// netCDF-4 is HDF5: netCDF follows the same addresses.
TEST(OceanFieldReader, SurvivesAFileThatHdf5DiesOf) {
  const std::string path =
      halocline::testing::write_channel_file(halocline::testing::channel_file(4, 1, 2), "no_names.nc");
  halocline::testing::lose_names(path);
  for (const auto& reading : std::vector<std::function<void()>>{[&] {
                                                                  read_ocean_field({path, "", kOrigin});
                                                                },
                                                                [&] { read_water_column({path}); }}) {
    try {
      reading();
      FAIL();
    } catch (const InvalidArgument& error) {
      EXPECT_THAT(error.what(), HasSubstr(path + " is damaged: the library that reads it crashes on it"));
    }
  }
}

TEST(OceanFieldReader, ReadsCurrentsAlone) {
  FieldFile file;
  file.temperature_name = "other";
  file.has_salinity = false;
  const auto field = read_ocean_field({write(file, "currents"), "", kOrigin});
  EXPECT_TRUE(field->has_current());
  EXPECT_FALSE(field->has_water());
}

}  // namespace
}  // namespace halocline::ocean
