// SPDX-License-Identifier: BSD-3-Clause
// Columns of water from CF netCDF grids, through GDAL. Part of the module halocline_profile_grids.so, which only
// profile_reader.cc loads.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <numbers>
#include <sstream>
#include <utility>
#include <vector>

#include <gdal_priv.h>

#include "acoustics/sea/profile_reader.h"
#include "acoustics/sea/sound_speed.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/check.h"
#include "core/elementary.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

constexpr double kEarthRadius = 6'371'008.8;  // m, mean (IUGG)
constexpr double kTurnDeg = 360;
constexpr const char* kTemperatureNames[] = {"t_an", "TEMP", "temperature", "T_AN", "temp", "thetao"};
constexpr const char* kSalinityNames[] = {"s_an", "SALT", "salinity", "S_AN", "salt", "so"};

using Dataset = std::unique_ptr<GDALDataset>;

Dataset open_quietly(const std::string& name) {
  CPLPushErrorHandler(CPLQuietErrorHandler);
  Dataset dataset(GDALDataset::Open(name.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
  CPLPopErrorHandler();
  return dataset;
}

template <std::size_t N>
Dataset open_variable(const std::string& path, const char* const (&names)[N], const char* what) {
  GDALAllRegister();
  for (const char* name : names) {
    Dataset dataset = open_quietly("NETCDF:\"" + path + "\":" + name);
    if (dataset && dataset->GetRasterCount() > 0) return dataset;
  }
  std::string known;
  for (const char* name : names) known += std::string(known.empty() ? "" : ", ") + name;
  throw InvalidArgument(path + ": no variable of " + what + " on a grid; known names are " + known);
}

// Dimensions besides latitude and longitude, outermost first, from "{time,depth}".
std::vector<std::string> extra_dimensions(GDALDataset& dataset) {
  const char* text = dataset.GetMetadataItem("NETCDF_DIM_EXTRA");
  std::vector<std::string> names;
  std::istringstream stream(text != nullptr ? text : "");
  std::string name;
  while (std::getline(stream, name, ',')) {
    std::erase_if(name, [](char c) { return c == '{' || c == '}' || c == ' '; });
    names.push_back(name);
  }
  return names;
}

// One variable on its grid: which bands are the levels of the chosen time, and where its cells lie.
class Grid {
 public:
  Grid(Dataset dataset, int time_index, std::string path)
      : dataset_(std::move(dataset)), path_(std::move(path)) {
    require(dataset_->GetGeoTransform(transform_) == CE_None && transform_[2] == 0 && transform_[4] == 0,
            path_ + ": no grid of latitude and longitude");
    find_levels(time_index);
  }

  int width() const { return dataset_->GetRasterXSize(); }
  int height() const { return dataset_->GetRasterYSize(); }
  double latitude_deg(int row) const { return transform_[3] + (row + 0.5) * transform_[5]; }
  double longitude_deg(int column) const { return transform_[0] + (column + 0.5) * transform_[1]; }
  const std::vector<double>& depths_m() const { return depths_m_; }
  bool matches(const Grid& other) const {
    return width() == other.width() && height() == other.height() && depths_m_ == other.depths_m_ &&
           std::equal(std::begin(transform_), std::end(transform_), std::begin(other.transform_));
  }

  // Values of a level in a window; NaN where there is none.
  std::vector<double> read(std::size_t level, int column, int row, int columns, int rows) const {
    GDALRasterBand& band = *dataset_->GetRasterBand(bands_[level]);
    std::vector<double> values(static_cast<std::size_t>(columns) * rows);
    const CPLErr error = band.RasterIO(GF_Read, column, row, columns, rows, values.data(), columns, rows,
                                       GDT_Float64, 0, 0, nullptr);
    require(error == CE_None, path_ + ": cannot be read");
    int has_fill = 0;
    const double fill = band.GetNoDataValue(&has_fill), scale = band.GetScale(), offset = band.GetOffset();
    for (double& value : values) {
      const bool filled = has_fill != 0 && std::abs(value - fill) <= 1e-6 * std::abs(fill);
      value = filled || std::abs(value) > 1e6 ? std::nan("") : value * scale + offset;
    }
    return values;
  }

 private:
  void find_levels(int time_index) {
    const std::vector<std::string> dimensions = extra_dimensions(*dataset_);
    require(!dimensions.empty(), path_ + ": the variable has no depths");
    const std::string depth_key = "NETCDF_DIM_" + dimensions.back();
    const char* positive = dataset_->GetMetadataItem((dimensions.back() + "#positive").c_str());
    const double sign = positive != nullptr && std::string(positive) == "up" ? -1 : 1;
    int time = -1;
    for (int b = 1; b <= dataset_->GetRasterCount(); ++b) {
      const char* text = dataset_->GetRasterBand(b)->GetMetadataItem(depth_key.c_str());
      require(text != nullptr, path_ + ": a level states no depth");
      const double depth = sign * std::atof(text);
      if (b == 1) first_depth_m_ = depth;
      if (depth == first_depth_m_) ++time;
      if (time != time_index) continue;
      bands_.push_back(b);
      depths_m_.push_back(depth);
    }
    require(!bands_.empty(), path_ + ": has " + std::to_string(time + 1) + " times; given is number " +
                                 std::to_string(time_index) + " (from 0)");
  }

  Dataset dataset_;
  std::string path_;
  double transform_[6] = {};
  double first_depth_m_ = 0;
  std::vector<int> bands_;
  std::vector<double> depths_m_;
};

// Great circle (haversine), degrees to metres.
double distance_m(double latitude_a, double longitude_a, double latitude_b, double longitude_b) {
  const double half_lat = to_radians(latitude_b - latitude_a) / 2,
               half_lon = to_radians(longitude_b - longitude_a) / 2;
  const double h = elementary::pow(elementary::sin(half_lat), 2) +
                   elementary::cos(to_radians(latitude_a)) * elementary::cos(to_radians(latitude_b)) *
                       elementary::pow(elementary::sin(half_lon), 2);
  return 2 * kEarthRadius * elementary::asin(std::sqrt(std::min(h, 1.0)));
}

struct Column {
  int column = -1, row = -1;
  double distance_m = std::numeric_limits<double>::infinity();
};

Column nearest_column(const Grid& temperature, const Grid& salinity, double latitude_deg,
                      double longitude_deg) {
  const std::vector<double> t = temperature.read(0, 0, 0, temperature.width(), temperature.height());
  const std::vector<double> s = salinity.read(0, 0, 0, salinity.width(), salinity.height());
  Column best;
  for (int row = 0; row < temperature.height(); ++row) {
    for (int column = 0; column < temperature.width(); ++column) {
      const std::size_t cell = static_cast<std::size_t>(row) * temperature.width() + column;
      if (std::isnan(t[cell]) || std::isnan(s[cell])) continue;
      const double away = distance_m(latitude_deg, longitude_deg, temperature.latitude_deg(row),
                                     temperature.longitude_deg(column));
      if (away < best.distance_m) best = {column, row, away};
    }
  }
  return best;
}

// Down to the first level without value.
std::vector<WaterRow> read_column(const Grid& temperature, const Grid& salinity, const Column& at) {
  std::vector<WaterRow> rows;
  for (std::size_t level = 0; level < temperature.depths_m().size(); ++level) {
    const double t = temperature.read(level, at.column, at.row, 1, 1)[0];
    const double s = salinity.read(level, at.column, at.row, 1, 1)[0];
    if (std::isnan(t) || std::isnan(s)) break;
    rows.push_back({temperature.depths_m()[level], t, s});
  }
  return rows;
}

std::string describe(const GridProfile& result) {
  std::ostringstream text;
  text.precision(4);
  text << std::fixed << "column at " << to_degrees(result.column_latitude_rad) << " N "
       << to_degrees(result.column_longitude_rad) << " E, ";
  text.precision(1);
  text << result.distance_m / 1000 << " km away, " << result.levels << " levels";
  return text.str();
}

GridProfile read_grid(const GridQuery& query, SoundSpeedModel model) {
  require(model != SoundSpeedModel::kTeos10,
          "gridded climatologies hold no absolute salinity: teos10 cannot use them");
  require_in_range(query.latitude_rad, -std::numbers::pi / 2, std::numbers::pi / 2, "latitude", "rad");
  require_finite(query.longitude_rad, "longitude");
  const std::string& salinity_path =
      query.salinity_path.empty() ? query.temperature_path : query.salinity_path;
  const Grid temperature(open_variable(query.temperature_path, kTemperatureNames, "temperature"),
                         query.time_index, query.temperature_path);
  const Grid salinity(open_variable(salinity_path, kSalinityNames, "salinity"), query.time_index,
                      salinity_path);
  require(temperature.matches(salinity), salinity_path + ": temperature and salinity are on different grids");

  const Column at = nearest_column(temperature, salinity, to_degrees(query.latitude_rad),
                                   std::remainder(to_degrees(query.longitude_rad), kTurnDeg));
  require(at.distance_m <= kFarthestColumn,
          query.temperature_path + ": no water within 300 km of the position");
  std::vector<WaterRow> rows = read_column(temperature, salinity, at);
  const int levels = static_cast<int>(rows.size());
  GridProfile result{SoundSpeedProfile::from_water(std::move(rows), model, query.latitude_rad),
                     to_radians(temperature.latitude_deg(at.row)),
                     to_radians(std::remainder(temperature.longitude_deg(at.column), kTurnDeg)),
                     at.distance_m,
                     levels,
                     ""};
  result.description = describe(result);
  return result;
}

}  // namespace
}  // namespace halocline::acoustics

extern "C" halocline::acoustics::GridProfileReader halocline_read_grid_profile;

halocline::acoustics::GridProfile* halocline_read_grid_profile(const halocline::acoustics::GridQuery& query,
                                                               halocline::acoustics::SoundSpeedModel model) {
  return new halocline::acoustics::GridProfile(halocline::acoustics::read_grid(query, model));
}
