// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/rasters/raster_source.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/shared_module.h"

namespace halocline::bathymetry {

std::unique_ptr<RasterSource> RasterSource::open(const RasterOptions& options, double origin_latitude_deg,
                                                 double origin_longitude_deg) {
  static const auto open_raster =
      reinterpret_cast<RasterOpener*>(module_symbol("halocline_rasters.so", "halocline_open_raster"));
  return std::unique_ptr<RasterSource>(open_raster(options, origin_latitude_deg, origin_longitude_deg));
}

double RasterWindow::depth_at(const PixelPosition& at) const {
  constexpr double kRoundingPosts = 1e-6;  // tolerance for positions beyond the last post
  const double c = at.column - first_column, r = at.row - first_row;
  if (!(c >= -kRoundingPosts && r >= -kRoundingPosts && c <= columns - 1 + kRoundingPosts &&
        r <= rows - 1 + kRoundingPosts)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const int i = std::clamp(static_cast<int>(r), 0, rows - 2),
            j = std::clamp(static_cast<int>(c), 0, columns - 2);
  const double v = std::clamp(r - i, 0.0, 1.0), u = std::clamp(c - j, 0.0, 1.0);
  const auto term = [&](int di, int dj, double weight) {
    const std::size_t n = static_cast<std::size_t>(i + di) * static_cast<std::size_t>(columns) +
                          static_cast<std::size_t>(j + dj);
    return weight > 0 ? weight * double{depths_m[n]} : 0.0;  // a post of weight 0 may be NaN
  };
  return term(0, 0, (1 - v) * (1 - u)) + term(0, 1, (1 - v) * u) + term(1, 0, v * (1 - u)) +
         term(1, 1, v * u);
}

}  // namespace halocline::bathymetry
