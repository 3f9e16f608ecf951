// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/report/seabed_raster.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace halocline::clients {
namespace {

// Colours of cmocean's "deep" at twelve even steps (Thyng et al. 2016, Oceanography 29(3), 9-13).
constexpr std::array<std::array<std::uint8_t, 3>, 12> kDeep{{{253, 253, 204},
                                                             {206, 236, 179},
                                                             {156, 219, 165},
                                                             {111, 201, 163},
                                                             {86, 177, 163},
                                                             {76, 153, 160},
                                                             {68, 130, 155},
                                                             {62, 108, 150},
                                                             {62, 82, 143},
                                                             {64, 60, 115},
                                                             {54, 43, 77},
                                                             {39, 26, 44}}};

// Returns the cubic of Catmull and Rom (1974) between b and c, t in [0, 1]; a and d are the values beyond
// them.
double cubic(double a, double b, double c, double d, double t) {
  return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

// Returns the bicubic surface at a position, m; NaN when one of the sixteen surrounding posts is missing.
double smooth_depth_m(const TerrainOverview& terrain, double north_m, double east_m) {
  const double row = (north_m - terrain.south_m) / terrain.north_spacing_m;
  const double column = (east_m - terrain.west_m) / terrain.east_spacing_m;
  const auto last_row = static_cast<std::ptrdiff_t>(terrain.rows) - 1;
  const auto last_column = static_cast<std::ptrdiff_t>(terrain.columns) - 1;
  const auto r = std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(std::floor(row)), 0, last_row - 1);
  const auto c =
      std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(std::floor(column)), 0, last_column - 1);
  std::array<double, 4> along{};
  for (std::ptrdiff_t i = 0; i < 4; ++i) {
    const auto at = [&](std::ptrdiff_t k) -> double {
      return terrain.post_m(static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(r - 1 + i, 0, last_row)),
                            static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(c - 1 + k, 0, last_column)));
    };
    along[static_cast<std::size_t>(i)] = cubic(at(0), at(1), at(2), at(3), column - static_cast<double>(c));
  }
  return cubic(along[0], along[1], along[2], along[3], row - static_cast<double>(r));
}

double depth_m(const TerrainOverview& terrain, double north_m, double east_m) {
  const double linear = terrain.depth_at_m(north_m, east_m);
  if (std::isnan(linear)) return linear;
  const double smooth = smooth_depth_m(terrain, north_m, east_m);
  return std::isnan(smooth) ? linear : smooth;
}

// Returns the brightness of a slope, given by its rise per metre toward north and east, under light from the
// north-west at an elevation of 45 degrees; 1 on a level seabed.
//   brightness = max(0, n . l) / l_up,  n = (-north, -east, 1) / sqrt(1 + north^2 + east^2),
//   l = (1/2, -1/2, 1/sqrt(2)) in north, east, up
double light(double toward_north, double toward_east) {
  constexpr double kRoot = 0.7071067811865476, kNorth = 0.5, kWest = 0.5;
  return std::max(0.0, (kRoot - kNorth * toward_north + kWest * toward_east) /
                           std::sqrt(1 + toward_north * toward_north + toward_east * toward_east)) /
         kRoot;
}

// Height gained per metre at a pixel toward north and east; 0 where it is unknown.
struct Slope {
  double north = 0, east = 0;
};

Slope slope_at(const SeabedRaster& raster, std::size_t x, std::size_t y, double pixel_north_m,
               double pixel_east_m) {
  const auto at = [&](std::size_t i, std::size_t k) -> double {
    return raster.depth_m[k * raster.width + i];
  };
  const std::size_t west = x > 0 ? x - 1 : x, east = std::min(x + 1, raster.width - 1);
  const std::size_t south = y > 0 ? y - 1 : y, north = std::min(y + 1, raster.height - 1);
  const Slope slope{(at(x, south) - at(x, north)) / (static_cast<double>(north - south) * pixel_north_m),
                    (at(west, y) - at(east, y)) / (static_cast<double>(east - west) * pixel_east_m)};
  return std::isfinite(slope.north) && std::isfinite(slope.east) ? slope : Slope{};
}

}  // namespace

std::array<std::uint8_t, 3> deep_colour(double share) {
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(kDeep.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), kDeep.size() - 2);
  std::array<std::uint8_t, 3> colour{};
  for (std::size_t i = 0; i < 3; ++i)
    colour[i] = static_cast<std::uint8_t>(
        std::lround(std::lerp(kDeep[below][i], kDeep[below + 1][i], place - static_cast<double>(below))));
  return colour;
}

SeabedRaster seabed_raster(const TerrainOverview& terrain, const MapExtent& extent, std::size_t width,
                           std::size_t height) {
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  SeabedRaster raster{
      width,     height,    std::vector<std::uint8_t>(4 * width * height), std::vector<float>(width * height),
      kInfinite, -kInfinite};
  const double pixel_north_m = (extent.north_m - extent.south_m) / static_cast<double>(height);
  const double pixel_east_m = (extent.east_m - extent.west_m) / static_cast<double>(width);
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const auto depth =
          static_cast<float>(depth_m(terrain, extent.south_m + (static_cast<double>(y) + 0.5) * pixel_north_m,
                                     extent.west_m + (static_cast<double>(x) + 0.5) * pixel_east_m));
      raster.depth_m[y * width + x] = depth;
      if (std::isnan(depth)) continue;
      raster.least_m = std::min(raster.least_m, depth);
      raster.greatest_m = std::max(raster.greatest_m, depth);
    }
  }
  if (width < 2 || height < 2 || raster.least_m > raster.greatest_m) return raster;
  double squares = 1e-12;
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const Slope slope = slope_at(raster, x, y, pixel_north_m, pixel_east_m);
      squares += slope.north * slope.north + slope.east * slope.east;
    }
  }
  // Slopes are exaggerated to 20 degrees rms; less where the seabed is level except for noise.
  const double rms = std::sqrt(squares / static_cast<double>(width * height));
  const double exaggeration = std::min(0.36 / rms, 20.0);
  const double span = std::max(raster.greatest_m - raster.least_m, 1e-3F);
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const float depth = raster.depth_m[y * width + x];
      if (std::isnan(depth)) continue;
      const Slope slope = slope_at(raster, x, y, pixel_north_m, pixel_east_m);
      const double brightness =
          std::clamp(0.55 + 0.45 * light(slope.north * exaggeration, slope.east * exaggeration), 0.4, 1.15);
      // The colours used are those from an eighth to seven eighths of the scale: shading needs the lightest
      // and the darkest.
      const auto colour = deep_colour(0.12 + 0.7 * (depth - raster.least_m) / span);
      std::uint8_t* pixel = &raster.rgba[4 * (y * width + x)];
      for (std::size_t i = 0; i < 3; ++i)
        pixel[i] = static_cast<std::uint8_t>(std::lround(std::min(255.0, colour[i] * brightness)));
      pixel[3] = 255;
    }
  }
  return raster;
}

}  // namespace halocline::clients
