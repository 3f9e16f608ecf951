// SPDX-License-Identifier: BSD-3-Clause
// Raster source based on GDAL. Part of the module halocline_rasters.so, which only raster_source.cc loads.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <cpl_conv.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include "bathymetry/rasters/gdal_support.h"
#include "bathymetry/rasters/netcdf_raster_source.h"
#include "bathymetry/rasters/raster_options.h"
#include "bathymetry/rasters/raster_source.h"
#include "bathymetry/rasters/raster_windows.h"
#include "bathymetry/rasters/vertical_sense.h"
#include "core/check.h"
#include "core/memory/memory_budget.h"

namespace halocline::bathymetry {
namespace {

constexpr double kTurnDeg = 360;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t kMaxPostsRead = std::int64_t{1} << 28;  // 1 GiB of floats

// Affine transform from column and row to coordinates at posts, not pixel edges:
//
//   x = origin_x + step_x column + skew_x row
//   y = origin_y + skew_y column + step_y row
struct PostTransform {
  double origin_x = 0, step_x = 1, skew_x = 0;
  double origin_y = 0, skew_y = 0, step_y = 1;

  PixelPosition pixel(double x, double y) const {
    const double dx = x - origin_x, dy = y - origin_y, determinant = step_x * step_y - skew_x * skew_y;
    return {(dx * step_y - dy * skew_x) / determinant, (dy * step_x - dx * skew_y) / determinant};
  }
};

// GDAL's geotransform of pixel edges: x, dx / dcolumn, dx / drow, y, dy / dcolumn, dy / drow.
using EdgeTransform = std::array<double, 6>;

EdgeTransform edges_of(const RasterBounds& bounds, int columns, int rows) {
  require(bounds.west < bounds.east && bounds.south < bounds.north,
          "bounds: west < east and south < north are needed");
  const double step_x = (bounds.east - bounds.west) / columns, step_y = (bounds.north - bounds.south) / rows;
  if (bounds.row_order == RowOrder::kSouthFirst) return {bounds.west, step_x, 0, bounds.south, 0, step_y};
  return {bounds.west, step_x, 0, bounds.north, 0, -step_y};
}

PostTransform posts_of(const EdgeTransform& edges, Registration registration, int columns, int rows) {
  if (registration == Registration::kNode) {
    require(edges[2] == 0 && edges[4] == 0, "registration = node needs unrotated axes");
    return {edges[0], edges[1] * columns / (columns - 1), 0, edges[3], 0, edges[5] * rows / (rows - 1)};
  }
  return {edges[0] + 0.5 * (edges[1] + edges[2]), edges[1], edges[2],
          edges[3] + 0.5 * (edges[4] + edges[5]), edges[4], edges[5]};
}

class GdalRasterSource final : public RasterSource {
 public:
  GdalRasterSource(const RasterOptions& options, double origin_latitude_deg, double origin_longitude_deg);

  int columns() const override { return state_.columns; }
  int rows() const override { return state_.rows; }
  bool is_local() const override { return state_.local; }
  std::string coordinate_system() const override { return state_.coordinate_system_name; }
  std::string vertical_datum() const override {
    return state_.vertical_datum.empty() ? "unstated" : state_.vertical_datum;
  }
  std::vector<std::string> warnings() const override { return state_.warnings; }
  PixelPosition pixel_at(double latitude_deg, double longitude_deg) const override;
  PixelPosition pixel_at_local(double north_m, double east_m) const override {
    return state_.posts.pixel(east_m, north_m);
  }
  LocalPosts local_posts() const override;
  RasterWindow read(const PixelPosition& low, const PixelPosition& high, PostCounts& counts) const override;

 private:
  struct State {
    RasterOptions options;
    gdal::Dataset dataset;
    GDALRasterBand* band = nullptr;
    int columns = 0, rows = 0;
    PostTransform posts;
    bool local = false, geographic = false;
    int period = 0;  // columns of a full turn; 0 when the raster does not span the earth
    double origin_longitude_deg = 0;
    std::string coordinate_system_name, vertical_datum;
    std::vector<std::string> warnings;
    bool is_down = false;             // values are depths
    gdal::Transformation from_wgs84;  // null when coordinates are longitude and latitude on WGS84

    void place();
    void name_coordinate_system(double origin_latitude_deg);
    void close_the_turn();
    void unwrap_around_origin();
    void read_block(int first_column, int columns_read, RasterWindow& window, PostCounts& counts) const;
  };

  State state_;
};

void GdalRasterSource::State::place() {
  EdgeTransform edges{};
  const bool placed = dataset->GetGeoTransform(edges.data()) == CE_None;
  require(placed || options.bounds,
          options.path.place() + ": the raster has no geotransform; give its bounds and row order");
  require(!placed || !options.bounds,
          options.path.place() + ": the raster has a geotransform; bounds would contradict it");
  if (!placed) edges = edges_of(*options.bounds, columns, rows);
  posts = posts_of(edges, options.registration, columns, rows);
  require(std::abs(posts.step_x * posts.step_y - posts.skew_x * posts.skew_y) > 0,
          options.path.place() + ": the raster's geotransform has no inverse");
}

void GdalRasterSource::State::name_coordinate_system(double origin_latitude_deg) {
  const OGRSpatialReference* declared = dataset->GetSpatialRef();
  if (options.coordinate_system == "local" || (declared != nullptr && declared->IsLocal())) {
    local = true;
    coordinate_system_name = "local metres";
    return;
  }
  OGRSpatialReference system;
  if (!options.coordinate_system.empty()) {
    // SetFromUserInput is limited to definitions and codes; files and addresses are refused.
    require(
        system.SetFromUserInput(options.coordinate_system.c_str(),
                                OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS_get()) == OGRERR_NONE,
        "coordinate_system '" + options.coordinate_system + "' is not known to PROJ");
  } else if (declared != nullptr) {
    system = *declared;
  } else {
    geographic = true;
    unwrap_around_origin();
    const PixelPosition origin = posts.pixel(origin_longitude_deg, origin_latitude_deg);
    require(origin.column >= -1 && origin.column <= columns && origin.row >= -1 && origin.row <= rows,
            options.path.place() +
                ": the raster names no coordinate system and, read as degrees, does not hold the "
                "scenario's origin; set coordinate_system = \"EPSG:...\" or \"local\"");
    coordinate_system_name = "assumed WGS 84 degrees";
    return;
  }
  coordinate_system_name = system.GetName() != nullptr ? system.GetName() : "unnamed";
  geographic = system.IsGeographic() != 0;
  from_wgs84 = gdal::transformation_from_wgs84(system);
  if (vertical_datum.empty()) vertical_datum = gdal::vertical_datum_of(system);
}

// Sets the exact step of a raster that spans the earth: a full turn over its columns, whatever its rounded
// axis states.
void GdalRasterSource::State::close_the_turn() {
  if (!geographic || posts.skew_x != 0 || posts.skew_y != 0) return;
  const double turn = std::abs(kTurnDeg / posts.step_x);
  const int nearest = static_cast<int>(std::min(std::lround(turn), 1'000'000'000L));
  if (nearest < 2 || nearest > columns || std::abs(turn - nearest) >= 0.5) return;
  period = nearest;
  posts.step_x = std::copysign(kTurnDeg / period, posts.step_x);
}

// Shifts the origin's longitude by full turns to the one nearest to the raster's middle.
void GdalRasterSource::State::unwrap_around_origin() {
  const double middle = posts.origin_x + 0.5 * posts.step_x * (columns - 1);
  origin_longitude_deg -= kTurnDeg * std::round((origin_longitude_deg - middle) / kTurnDeg);
}

GdalRasterSource::GdalRasterSource(const RasterOptions& options, double origin_latitude_deg,
                                   double origin_longitude_deg) {
  State& s = state_;
  s.options = options;
  s.vertical_datum = options.vertical_datum;
  s.origin_longitude_deg = origin_longitude_deg;
  // GDAL may turn netCDF files without coordinates upside down by its own rules; with given bounds, the
  // file's order holds.
  s.dataset = gdal::open(options.path.place(), options.variable, options.bounds.has_value(), s.warnings);
  s.columns = s.dataset->GetRasterXSize();
  s.rows = s.dataset->GetRasterYSize();
  require(s.columns >= 2 && s.rows >= 2, options.path.place() + ": a raster needs at least 2 x 2 posts");
  require(options.band >= 1 && options.band <= s.dataset->GetRasterCount(),
          options.path.place() + ": there is no band " + std::to_string(options.band));
  s.band = s.dataset->GetRasterBand(options.band);
  const auto declared = [&](const char* key) {
    const char* text = s.band->GetMetadataItem(key);
    return std::string(text == nullptr ? "" : text);
  };
  s.is_down = holds_depths(declared("positive"), declared("standard_name"), options);
  s.place();
  s.name_coordinate_system(origin_latitude_deg);
  s.close_the_turn();
  if (s.geographic) s.unwrap_around_origin();
}

PixelPosition GdalRasterSource::pixel_at(double latitude_deg, double longitude_deg) const {
  double x = longitude_deg, y = latitude_deg;
  if (state_.from_wgs84 && state_.from_wgs84->Transform(1, &x, &y) == 0) return {kNaN, kNaN};
  if (state_.geographic) {
    x = state_.origin_longitude_deg + std::remainder(x - state_.origin_longitude_deg, kTurnDeg);
  }
  return state_.posts.pixel(x, y);
}

RasterSource::LocalPosts GdalRasterSource::local_posts() const {
  const PostTransform& p = state_.posts;
  require(p.skew_x == 0 && p.skew_y == 0 && p.step_x > 0 &&
              std::abs(p.step_x - std::abs(p.step_y)) <= 1e-9 * p.step_x,
          state_.options.path.place() + ": a local raster needs square pixels along north and east");
  const bool south_first = p.step_y > 0;
  return {south_first ? p.origin_y : p.origin_y + p.step_y * (state_.rows - 1), p.origin_x, p.step_x,
          south_first};
}

// Reads one contiguous run of columns into the window's columns that it covers.
void GdalRasterSource::State::read_block(int first_column, int columns_read, RasterWindow& window,
                                         PostCounts& counts) const {
  const int wrapped = period > 0 ? ((first_column % period) + period) % period : first_column;
  const std::size_t row_length = static_cast<std::size_t>(window.columns);
  const std::size_t skip = static_cast<std::size_t>(first_column - window.first_column);
  float* out = window.depths_m.data() + skip;
  gdal::read_floats(*band, {wrapped, window.first_row, columns_read, window.rows}, out, row_length);
  const gdal::BandMeaning meaning = gdal::meaning_of(*band, options.no_data);
  const std::vector<unsigned char> mask =
      gdal::read_mask(*band, {wrapped, window.first_row, columns_read, window.rows});
  const double sign = is_down ? 1 : -1;
  for (std::size_t r = 0; r < static_cast<std::size_t>(window.rows); ++r) {
    for (std::size_t c = 0; c < static_cast<std::size_t>(columns_read); ++c) {
      float& value = out[r * row_length + c];
      const bool masked = !mask.empty() && mask[r * static_cast<std::size_t>(columns_read) + c] == 0;
      if (masked || meaning.is_no_data(value)) {
        ++counts.declared_no_data;
        value = std::numeric_limits<float>::quiet_NaN();
      } else {
        value = static_cast<float>(sign * meaning.metres(value));
      }
    }
  }
}

RasterWindow GdalRasterSource::read(const PixelPosition& low, const PixelPosition& high,
                                    PostCounts& counts) const {
  const State& s = state_;
  // A global raster may be entered from either side of its seam, by one turn at most.
  RasterWindow window = s.period > 0 ? window_between(low, high, -s.period, 2 * s.period, s.rows)
                                     : window_between(low, high, 0, s.columns - 1, s.rows);
  if (window.columns == 0) return window;
  const std::int64_t posts = std::int64_t{window.columns} * window.rows;
  require(posts <= kMaxPostsRead, s.options.path.place() + ": the scenario covers " + std::to_string(posts) +
                                      " posts of the raster, more than 2^28; take a smaller domain");
  require_memory(static_cast<double>(posts) * sizeof(float),
                 "the part of " + s.options.path.place() + " under the terrain", "take a smaller domain");
  window.depths_m.resize(static_cast<std::size_t>(posts));
  const int end_column = window.first_column + window.columns;
  for (int column = window.first_column; column < end_column;) {
    const int wrapped = s.period > 0 ? ((column % s.period) + s.period) % s.period : column;
    const int run = std::min(end_column - column, (s.period > 0 ? s.period : s.columns) - wrapped);
    s.read_block(column, run, window, counts);
    column += run;
  }
  finish(window, s.options, counts);
  return window;
}

}  // namespace
}  // namespace halocline::bathymetry

extern "C" halocline::bathymetry::RasterOpener halocline_open_raster;

halocline::bathymetry::RasterSource* halocline_open_raster(
    const halocline::bathymetry::RasterOptions& options, double origin_latitude_deg,
    double origin_longitude_deg) {
  using namespace halocline::bathymetry;
  if (auto source = open_uneven_netcdf(options, origin_latitude_deg, origin_longitude_deg))
    return source.release();
  return new GdalRasterSource(options, origin_latitude_deg, origin_longitude_deg);
}
