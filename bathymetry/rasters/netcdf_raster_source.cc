// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/rasters/netcdf_raster_source.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bathymetry/rasters/raster_windows.h"
#include "bathymetry/rasters/vertical_sense.h"
#include "core/check.h"
#include "core/files/input_file.h"
#include "ocean/cf_axis.h"
#include "ocean/cf_units.h"
#include "ocean/netcdf_file.h"
#include "ocean/netcdf_header.h"

namespace halocline::bathymetry {
namespace {

using ocean::AxisKind;
using ocean::CfAxis;
using ocean::NetcdfFile;

constexpr std::size_t kMaxAxisLength = 1'000'000;
constexpr double kFullTurnDeg = 360;
constexpr double kEvenWithin = 0.05;                             // share of a step, for the rounding of axes
constexpr std::int64_t kMaxPostsAtOnce = std::int64_t{1} << 28;  // limit of a window: 1 GiB of floats

bool is_even(const std::vector<double>& values) {
  const double count = static_cast<double>(values.size()),
               step = (values.back() - values.front()) / (count - 1);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double even = values.front() + step * static_cast<double>(i);
    if (std::abs(values[i] - even) > kEvenWithin * std::abs(step)) return false;
  }
  return true;
}

// Returns the position of a value along the posts of an axis, as a fractional index; beyond its ends, the
// outermost cells are extrapolated.
double position_on(const std::vector<double>& posts, double value) {
  const auto above = std::upper_bound(posts.begin() + 1, posts.end() - 1, value);
  const auto low = above - 1;
  return static_cast<double>(low - posts.begin()) + (value - *low) / (*above - *low);
}

// Axes of a variable by kind, from its last dimensions that have coordinates.
struct Layout {
  std::string variable = {};
  std::string latitude = {}, longitude = {};  // coordinate variables; empty: none
  bool latitude_first = true;
  std::vector<std::string> others = {};  // coordinate variables of another kind
};

Layout layout_of(const NetcdfFile& file, const std::string& variable) {
  Layout layout{.variable = variable};
  for (const std::string& dimension : file.dimensions_of(variable)) {
    const std::string name = ocean::coordinate_of(file, variable, dimension);
    if (name.empty()) continue;
    const AxisKind kind = ocean::kind_of(file, name);
    if (kind == AxisKind::kLatitude) layout.latitude_first = layout.longitude.empty();
    if (kind == AxisKind::kLatitude) layout.latitude = name;
    if (kind == AxisKind::kLongitude) layout.longitude = name;
    if (kind == AxisKind::kOther) layout.others.push_back(name);
  }
  return layout;
}

// Returns the layout of the wanted variable; else of the only one on latitudes and longitudes; else of the
// only two-dimensional one that is not itself a position. Empty when there are several.
std::optional<Layout> find_layout(const NetcdfFile& file, const std::string& wanted) {
  if (!wanted.empty()) return file.has(wanted) ? std::optional(layout_of(file, wanted)) : std::nullopt;
  std::vector<Layout> planes, placed;
  for (const std::string& variable : file.variables()) {
    const bool is_position = ocean::direction_in(file.text(variable, "units")) != ocean::Direction::kUnknown;
    if (file.dimensions_of(variable).size() < 2 || is_position) continue;
    planes.push_back(layout_of(file, variable));
    if (!planes.back().latitude.empty() && !planes.back().longitude.empty()) placed.push_back(planes.back());
  }
  const std::vector<Layout>& candidates = placed.empty() ? planes : placed;
  return candidates.size() == 1 ? std::optional(candidates.front()) : std::nullopt;
}

void refuse_other_grids(const NetcdfFile& file, const Layout& layout, const RasterOptions& options) {
  const std::string places = ocean::curvilinear_places(file, layout.variable);
  const bool is_placed = options.bounds || !options.coordinate_system.empty() ||
                         !file.text(layout.variable, "grid_mapping").empty();
  if (!places.empty() && !is_placed)
    file.refuse(layout.variable, places +
                                     "; allowed are axes of one dimension: regrid it first (cdo remapbil, "
                                     "gdalwarp -geoloc)");
  for (const std::string& name : layout.others) {
    const std::size_t length = file.length_of(file.dimensions_of(name).front());
    if (length < 3 || length > kMaxAxisLength) continue;
    const std::vector<double> values = file.values(name);
    if (std::isfinite(values.front()) && !is_even(values))
      file.refuse(name,
                  "is unevenly spaced, which is read of latitudes and longitudes alone: resample it first");
  }
}

class NetcdfRasterSource final : public RasterSource {
 public:
  NetcdfRasterSource(std::unique_ptr<NetcdfFile> file, const Layout& layout, const RasterOptions& options,
                     CfAxis latitudes, CfAxis longitudes, double origin_longitude_deg)
      : file_(std::move(file)),
        options_(options),
        variable_(layout.variable),
        latitudes_(std::move(latitudes)),
        longitudes_(std::move(longitudes)) {
    require(options.registration == Registration::kAsDeclared,
            options.path.place() + ": registration = node needs evenly spaced axes");
    require(!options.bounds, options.path.place() + ": the raster has axes; bounds would contradict them");
    ocean::move_seam(longitudes_, origin_longitude_deg);
    require(columns() >= 2 && rows() >= 2, options.path.place() + ": a raster needs at least 2 x 2 posts");
    place_band();
    const std::string unit = file_->text(variable_, "units");
    metres_ =
        unit.empty() ? ocean::UnitFactor{} : ocean::unit_of(*file_, variable_, ocean::QuantityKind::kLength);
    is_down_ =
        holds_depths(file_->text(variable_, "positive"), file_->text(variable_, "standard_name"), options);
  }

  int columns() const override { return static_cast<int>(longitudes_.values.size()); }
  int rows() const override { return static_cast<int>(latitudes_.values.size()); }
  bool is_local() const override { return false; }
  std::string coordinate_system() const override { return "latitudes and longitudes of its axes"; }
  std::string vertical_datum() const override {
    return options_.vertical_datum.empty() ? "unstated" : options_.vertical_datum;
  }
  std::vector<std::string> warnings() const override { return {}; }

  PixelPosition pixel_at(double latitude_deg, double longitude_deg) const override {
    const double middle = (longitudes_.values.front() + longitudes_.values.back()) / 2;
    return {position_on(longitudes_.values, middle + std::remainder(longitude_deg - middle, kFullTurnDeg)),
            position_on(latitudes_.values, latitude_deg)};
  }
  PixelPosition pixel_at_local(double, double) const override { return {std::nan(""), std::nan("")}; }
  LocalPosts local_posts() const override {
    throw InvalidArgument(options_.path.place() + ": a local raster needs evenly spaced axes in metres");
  }
  RasterWindow read(const PixelPosition& low, const PixelPosition& high, PostCounts& counts) const override;

 private:
  // Numbers the bands through all dimensions besides latitude and longitude, the last one varying fastest.
  void place_band() {
    const std::vector<std::string> dimensions = file_->dimensions_of(variable_);
    std::size_t rest = static_cast<std::size_t>(options_.band - 1);
    from_.assign(dimensions.size(), 0);
    counts_.assign(dimensions.size(), 1);
    for (std::size_t d = dimensions.size(); d-- > 0;) {
      if (dimensions[d] == latitudes_.dimension) row_dimension_ = d;
      if (dimensions[d] == longitudes_.dimension) column_dimension_ = d;
      if (dimensions[d] == latitudes_.dimension || dimensions[d] == longitudes_.dimension) continue;
      const std::size_t length = std::max<std::size_t>(file_->length_of(dimensions[d]), 1);
      from_[d] = rest % length;
      rest /= length;
    }
    require(rest == 0, options_.path.place() + ": there is no band " + std::to_string(options_.band));
  }
  // Returns the unpacked value that means no data by the options, in addition to the file's; NaN: none.
  double extra_no_data() const {
    const auto first = [&](const char* attribute, double otherwise) {
      const std::vector<double> found = file_->numbers(variable_, attribute);
      return found.empty() ? otherwise : found.front();
    };
    return options_.no_data ? *options_.no_data * first("scale_factor", 1) + first("add_offset", 0)
                            : std::nan("");
  }

  std::unique_ptr<NetcdfFile> file_;
  RasterOptions options_;
  std::string variable_;
  CfAxis latitudes_, longitudes_;
  std::vector<std::size_t> from_, counts_;
  std::size_t row_dimension_ = 0, column_dimension_ = 0;
  ocean::UnitFactor metres_;
  bool is_down_ = false;
};

RasterWindow NetcdfRasterSource::read(const PixelPosition& low, const PixelPosition& high,
                                      PostCounts& counts) const {
  RasterWindow window = window_between(low, high, 0, columns() - 1, rows());
  if (window.columns == 0) return window;
  const std::int64_t posts = std::int64_t{window.columns} * window.rows;
  require(posts <= kMaxPostsAtOnce, options_.path.place() + ": the scenario covers " + std::to_string(posts) +
                                        " posts of the raster, more than 2^28; take a smaller domain");
  const auto places = [](const CfAxis& axis, int first, int count) {
    return std::vector(axis.places.begin() + first, axis.places.begin() + first + count);
  };
  const auto rows = places(latitudes_, window.first_row, window.rows),
             columns = places(longitudes_, window.first_column, window.columns);
  std::vector<std::size_t> from = from_, box = counts_;
  for (const auto& [dimension, of] : {std::pair(row_dimension_, &rows), {column_dimension_, &columns}}) {
    const auto [least, greatest] = std::minmax_element(of->begin(), of->end());
    from[dimension] = *least;
    box[dimension] = *greatest - *least + 1;
  }
  const std::vector<double> values = file_->values(variable_, from, box);
  const bool rows_outside = row_dimension_ < column_dimension_;
  const std::size_t row_step = rows_outside ? box[column_dimension_] : 1,
                    column_step = rows_outside ? 1 : box[row_dimension_];
  const double extra = extra_no_data();
  window.depths_m.reserve(static_cast<std::size_t>(posts));
  for (const std::size_t row : rows) {
    for (const std::size_t column : columns) {
      const double value =
          values[(row - from[row_dimension_]) * row_step + (column - from[column_dimension_]) * column_step];
      const bool is_none = std::isnan(value) || value == extra;
      counts.declared_no_data += is_none ? 1 : 0;
      window.depths_m.push_back(is_none ? std::numeric_limits<float>::quiet_NaN()
                                        : static_cast<float>((is_down_ ? 1 : -1) * metres_(value)));
    }
  }
  finish(window, options_, counts);
  return window;
}

// Opens a netCDF file; null when that fails, because HDF5 has other contents too, which GDAL reads.
std::unique_ptr<NetcdfFile> open_file(const std::string& path) {
  if (ocean::netcdf_kind_of(path) == ocean::NetcdfKind::kClassic) return std::make_unique<NetcdfFile>(path);
  ocean::require_whole_netcdf(path);
  try {
    return std::make_unique<NetcdfFile>(path);
  } catch (const InvalidArgument&) {
    return nullptr;
  }
}

}  // namespace

std::unique_ptr<RasterSource> open_uneven_netcdf(const RasterOptions& options, double origin_latitude_deg,
                                                 double origin_longitude_deg) {
  const std::string& path = options.path.place();
  const bool is_name = is_any_raster_allowed() && !why_unreadable(path).empty();
  if (is_name || path.starts_with("/vsimem/") || ocean::netcdf_kind_of(path) == ocean::NetcdfKind::kNone)
    return nullptr;
  std::unique_ptr<NetcdfFile> file = open_file(path);
  const std::optional<Layout> layout = file ? find_layout(*file, options.variable) : std::nullopt;
  if (!layout) return nullptr;
  if (layout->latitude.empty() || layout->longitude.empty()) {
    refuse_other_grids(*file, *layout, options);
    return nullptr;
  }
  CfAxis latitudes = ocean::read_axis(*file, layout->latitude, AxisKind::kLatitude, origin_latitude_deg),
         longitudes = ocean::read_axis(*file, layout->longitude, AxisKind::kLongitude, origin_latitude_deg);
  if (layout->latitude_first && is_even(latitudes.values) && is_even(longitudes.values)) return nullptr;
  return std::make_unique<NetcdfRasterSource>(std::move(file), *layout, options, std::move(latitudes),
                                              std::move(longitudes), origin_longitude_deg);
}

}  // namespace halocline::bathymetry
