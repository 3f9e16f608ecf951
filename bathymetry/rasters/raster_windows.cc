// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/rasters/raster_windows.h"

#include <algorithm>
#include <cmath>

#include "bathymetry/rasters/suspect_values.h"

namespace halocline::bathymetry {

RasterWindow window_between(const PixelPosition& low, const PixelPosition& high, int first, int last,
                            int rows) {
  const bool apart = high.column < first || low.column > last || high.row < 0 || low.row > rows - 1;
  if (apart || std::isnan(low.column)) return {};
  const auto bounded = [](double value, int min, int max) {
    return static_cast<int>(std::clamp<double>(value, min, max));
  };
  const int first_column = bounded(std::floor(low.column), first, last),
            first_row = bounded(std::floor(low.row), 0, rows - 1);
  return {first_column,
          first_row,
          bounded(std::ceil(high.column), first, last) - first_column + 1,
          bounded(std::ceil(high.row), 0, rows - 1) - first_row + 1,
          {}};
}

void finish(RasterWindow& window, const RasterOptions& options, PostCounts& counts) {
  if (!options.trust_every_value) counts.undeclared_no_data += remove_suspects(window);
  for (float& depth : window.depths_m) depth += static_cast<float>(options.datum_offset_m);
}

}  // namespace halocline::bathymetry
