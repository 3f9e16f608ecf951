// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/rasters/raster_loader.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "bathymetry/rasters/raster_source.h"
#include "core/check.h"
#include "core/elementary.h"
#include "core/files/guarded_reading.h"
#include "core/huge_page_vector.h"
#include "core/units.h"

namespace halocline::bathymetry {
namespace {

constexpr int kBlockPosts = 16;        // posts in each direction that are mapped by their corners
constexpr double kMaxMapError = 1e-4;  // in pixels, at the block's middle, where the error is greatest
constexpr int kDepthRounds = 3;  // rounds of the fixed-point iteration in enu mode: each gains four digits

// Map from the plane of the grid to the raster's posts.
class PostMap {
 public:
  PostMap(const RasterSource& source, const LocalFrame& frame) : source_(source), frame_(frame) {}

  PixelPosition pixel(double x_m, double y_m, double z_m) const {
    if (source_.is_local()) return source_.pixel_at_local(x_m, y_m);
    const GeodeticPoint point = frame_.to_geodetic({x_m, y_m, z_m});
    return source_.pixel_at(to_degrees(point.latitude_rad), to_degrees(point.longitude_rad));
  }
  // Returns the depth below the datum of a point of the local frame.
  double depth(double x_m, double y_m, double z_m) const {
    return source_.is_local() ? z_m : frame_.to_geodetic({x_m, y_m, z_m}).depth_m;
  }
  bool depends_on_z() const { return !source_.is_local() && frame_.mode() == FrameMode::kEnu; }

 private:
  const RasterSource& source_;
  const LocalFrame& frame_;
};

PixelPosition between(const PixelPosition& p, const PixelPosition& q, double weight) {
  return {p.column + (q.column - p.column) * weight, p.row + (q.row - p.row) * weight};
}

// Bounds of the raster's posts under the grid: the map is continuous, so the mapped border encloses them.
struct PixelBounds {
  PixelPosition low{HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL};
  void include(const PixelPosition& p) {
    if (!std::isfinite(p.column) || !std::isfinite(p.row)) return;
    low = {std::min(low.column, p.column), std::min(low.row, p.row)};
    high = {std::max(high.column, p.column), std::max(high.row, p.row)};
  }
};

PixelBounds bounds_of(const PostMap& map, const GridGeometry& g) {
  constexpr double kDeepestM = 12'000;  // in enu mode the position on the earth depends slightly on depth
  PixelBounds bounds;
  for (const double z : {-kDeepestM, kDeepestM}) {
    for (int i = 0; i < g.posts_x; ++i) {
      bounds.include(map.pixel(g.x_at(i), g.first_y_m, z));
      bounds.include(map.pixel(g.x_at(i), g.last_y_m(), z));
    }
    for (int j = 0; j < g.posts_y; ++j) {
      bounds.include(map.pixel(g.first_x_m, g.y_at(j), z));
      bounds.include(map.pixel(g.last_x_m(), g.y_at(j), z));
    }
  }
  return {{bounds.low.column - 1, bounds.low.row - 1}, {bounds.high.column + 1, bounds.high.row + 1}};
}

// Returns z of the bottom at (x, y) where the position on the earth depends on z: the fixed point at which
// the depth of z equals the raster's depth there.
double depth_by_iteration(const PostMap& map, const RasterWindow& window, double x_m, double y_m) {
  double z = -map.depth(x_m, y_m, 0);  // z of the datum itself, below the tangent plane
  for (int round = 0; round < kDepthRounds; ++round) {
    z += window.depth_at(map.pixel(x_m, y_m, z)) - map.depth(x_m, y_m, z);
  }
  return z;
}

// Corners and middle of a block in the raster; decides whether bilinear interpolation between the corners is
// accurate enough.
class BlockMap {
 public:
  BlockMap(const PostMap& map, const GridGeometry& g, int i, int j, int rows, int columns)
      : map_(map), g_(g), i_(i), j_(j), rows_(rows), columns_(columns) {
    for (int corner = 0; corner < 4; ++corner) {
      corners_[corner] = exact(i + (corner / 2) * (rows - 1), j + (corner % 2) * (columns - 1));
    }
    const PixelPosition mean =
        between(between(corners_[0], corners_[1], 0.5), between(corners_[2], corners_[3], 0.5), 0.5);
    const PixelPosition middle =
        map.pixel(0.5 * (g.x_at(i) + g.x_at(i + rows - 1)), 0.5 * (g.y_at(j) + g.y_at(j + columns - 1)), 0);
    smooth_ = elementary::hypot(mean.column - middle.column, mean.row - middle.row) < kMaxMapError;
  }
  PixelPosition pixel(int i, int j) const {
    if (!smooth_) return exact(i, j);
    const double u = rows_ > 1 ? static_cast<double>(i - i_) / (rows_ - 1) : 0;
    const double v = columns_ > 1 ? static_cast<double>(j - j_) / (columns_ - 1) : 0;
    return between(between(corners_[0], corners_[1], v), between(corners_[2], corners_[3], v), u);
  }

 private:
  PixelPosition exact(int i, int j) const { return map_.pixel(g_.x_at(i), g_.y_at(j), 0); }

  const PostMap& map_;
  const GridGeometry& g_;
  int i_, j_, rows_, columns_;
  PixelPosition corners_[4];
  bool smooth_ = false;
};

void resample_block(const PostMap& map, const RasterWindow& window, int i0, int j0, HeightGrid& grid) {
  const GridGeometry& g = grid.geometry();
  const int rows = std::min(kBlockPosts, g.posts_x - i0), columns = std::min(kBlockPosts, g.posts_y - j0);
  const BlockMap block(map, g, i0, j0, rows, columns);
  for (int i = i0; i < i0 + rows; ++i) {
    for (int j = j0; j < j0 + columns; ++j) {
      const double z = map.depends_on_z() ? depth_by_iteration(map, window, g.x_at(i), g.y_at(j))
                                          : window.depth_at(block.pixel(i, j));
      grid.posts_for_editing()[grid.index(i, j)] = static_cast<float>(z);
    }
  }
}

RasterReport report_on(const RasterOptions& options, const RasterSource& source, const RasterWindow& window,
                       const PostCounts& counts, const HeightGrid& grid) {
  RasterReport report{.path = options.path.place(),
                      .coordinate_system = source.coordinate_system(),
                      .vertical_datum = source.vertical_datum(),
                      .datum_offset_m = options.datum_offset_m,
                      .raster_columns = source.columns(),
                      .raster_rows = source.rows(),
                      .window_columns = window.columns,
                      .window_rows = window.rows,
                      .declared_no_data = counts.declared_no_data,
                      .undeclared_no_data = counts.undeclared_no_data,
                      .shallowest_m = HUGE_VAL,
                      .deepest_m = -HUGE_VAL,
                      .warnings = source.warnings()};
  for (const float z : grid.posts()) {
    report.posts_without_depth += std::isnan(z);
    report.posts_above_datum += z < 0;
    report.shallowest_m = std::isnan(z) ? report.shallowest_m : std::min(report.shallowest_m, double{z});
    report.deepest_m = std::isnan(z) ? report.deepest_m : std::max(report.deepest_m, double{z});
  }
  require(report.posts_without_depth < grid.posts().size(),
          options.path.place() + ": the raster has no depth anywhere in the scenario's domain");
  if (report.undeclared_no_data > 0)
    report.warnings.push_back(
        std::to_string(report.undeclared_no_data) +
        " posts are taken as no data that it does not declare: beyond any sea and mountain, or 999 "
        "and 9999 far from what is around; trust_every_value = true keeps them");
  if (report.posts_above_datum + report.posts_without_depth == grid.posts().size())
    report.warnings.emplace_back("all of it lies above the sea; positive_down = true is for files of depths");
  return report;
}

LoadedRaster read_raster(const RasterOptions& options, const LocalFrame& frame,
                         const GridGeometry& geometry) {
  require_finite(options.datum_offset_m, "datum_offset_m");
  const std::unique_ptr<const RasterSource> opened = RasterSource::open(
      options, to_degrees(frame.origin_latitude_rad()), to_degrees(frame.origin_longitude_rad()));
  const RasterSource& source = *opened;
  HeightGrid grid(geometry, HugePageVector<float>(static_cast<std::size_t>(geometry.posts_x) *
                                                      static_cast<std::size_t>(geometry.posts_y),
                                                  std::numeric_limits<float>::quiet_NaN()));
  const PostMap map(source, frame);
  const PixelBounds bounds = bounds_of(map, geometry);
  PostCounts counts;
  const RasterWindow window = source.read(bounds.low, bounds.high, counts);
  if (window.columns >= 2 && window.rows >= 2) {
    for (int i = 0; i < geometry.posts_x; i += kBlockPosts) {
      for (int j = 0; j < geometry.posts_y; j += kBlockPosts) resample_block(map, window, i, j, grid);
    }
  }
  RasterReport report = report_on(options, source, window, counts, grid);
  return {std::move(grid), std::move(report)};
}

LoadedRaster read_local_raster(const RasterOptions& options) {
  require_finite(options.datum_offset_m, "datum_offset_m");
  const std::unique_ptr<const RasterSource> opened = RasterSource::open(options, 0, 0);
  const RasterSource& source = *opened;
  require(source.is_local(),
          options.path.place() + ": the raster is not in local metres; set coordinate_system = \"local\"");
  const RasterSource::LocalPosts posts = source.local_posts();
  PostCounts counts;
  RasterWindow window = source.read({0, 0}, {source.columns() - 1.0, source.rows() - 1.0}, counts);
  const std::size_t row_length = static_cast<std::size_t>(window.columns);
  if (!posts.south_first) {
    for (int low = 0, high = window.rows - 1; low < high; ++low, --high) {
      float* row = window.depths_m.data() + static_cast<std::size_t>(low) * row_length;
      std::swap_ranges(row, row + row_length,
                       window.depths_m.data() + static_cast<std::size_t>(high) * row_length);
    }
  }
  HeightGrid grid({posts.first_north_m, posts.first_east_m, posts.spacing_m, window.rows, window.columns},
                  std::move(window.depths_m));
  RasterReport report = report_on(options, source, window, counts, grid);
  return {std::move(grid), std::move(report)};
}

// Calls `reading`; files read by HDF5 (netCDF-4, BAG) are read behind the guard of
// core/files/guarded_reading.h.
template <class Reading>
LoadedRaster load(const RasterOptions& options, const Reading& reading) {
  return is_hdf5(options.path.place()) ? guarded_reading({options.path.place()}, reading) : reading();
}

}  // namespace

LoadedRaster load_raster(const RasterOptions& options, const LocalFrame& frame,
                         const GridGeometry& geometry) {
  return load(options, [&] { return read_raster(options, frame, geometry); });
}

LoadedRaster load_local_raster(const RasterOptions& options) {
  return load(options, [&] { return read_local_raster(options); });
}

}  // namespace halocline::bathymetry
