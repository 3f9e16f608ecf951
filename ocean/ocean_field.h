// SPDX-License-Identifier: BSD-3-Clause
// Ocean current, temperature and salinity as functions of position and time.
//
// Model. Values are given on a grid of time, depth, latitude and longitude, as from ocean models (HYCOM, ROMS
// on depth levels), and interpolated linearly in each of the four. Beyond the first and last time, level, row
// and column, the values there continue. Points without a value, in the seabed and on land, are filled:
// - Below the deepest value of a column, that value continues; above its highest value, that one.
// - A column without any value takes that of the column the fewest steps away along the grid, so currents run
//   along coasts at full speed.
//
// Vertical currents are left out.
//
// Frames: the world NED in its flat mode (bathymetry/terrain/local_frame.h), a transverse Mercator projection
// about the origin. Its inverse is evaluated to second order: 10 m error at 100 km, at latitude 45 degrees.
// East and north of the file are rotated by the meridian convergence at the position. Depth is below the sea
// surface, m, of any sign; time is simulation time, s.
//
//   const OceanField field(grid, std::move(values), {to_radians(40), to_radians(-50)});
//   const Vec3 current = field.current_ned_mps({1000, 2000, 50}, 3600);
//
// Error: what the grid does not resolve. Immutable: calls may overlap between threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/frames.h"

namespace halocline::ocean {

// Axes of a grid, each rising, with one value or more; angles in radians, longitudes within less than a turn.
struct OceanGrid {
  std::vector<double> times_s, depths_m, latitudes_rad, longitudes_rad;
  std::size_t levels() const { return times_s.size() * depths_m.size(); }
  std::size_t columns() const { return latitudes_rad.size() * longitudes_rad.size(); }
};

// Values by [time][depth][latitude][longitude]; NaN where the file has none. An empty vector is a variable
// that the file does not have. Both components of the current are present or neither, and likewise
// temperature (in situ, ITS-90) and salinity (practical).
struct OceanValues {
  std::vector<float> east_mps, north_mps;             // -10..10
  std::vector<float> temperature_degc, salinity_psu;  // -5..45, 0..50
};

struct GeodeticOrigin {
  double latitude_rad = 0, longitude_rad = 0;  // origin of the world NED, WGS 84
};

struct WaterAtDepth {
  double depth_m, temperature_degc, salinity_psu;
};

// Bounds on the water of a layer, from the values of a field.
struct WaterRange {
  double least_degc, greatest_degc, least_psu, greatest_psu;
};

class OceanField {
 public:
  // Throws InvalidArgument that names the axis or the variable, the value and what is allowed; also when the
  // origin lies outside of the grid or a variable has no value at one of its times.
  OceanField(OceanGrid grid, OceanValues values, const GeodeticOrigin& origin,
             std::vector<std::string> remarks = {});

  bool has_current() const { return !values_.east_mps.empty(); }
  bool has_water() const { return !values_.temperature_degc.empty(); }
  bool is_steady() const { return grid_.times_s.size() == 1; }
  const OceanGrid& grid() const { return grid_; }

  // True when a position lies within the grid.
  bool covers(double north_m, double east_m) const;

  // Returns the current, for a field with currents. `place` is north and east in the world NED, and depth, m.
  Vec3 current_ned_mps(const Vec3& place, double time_s) const;
  WaterAtDepth water_at(const Vec3& place, double time_s) const;
  // Returns the water at all levels of the grid, linearly interpolated.
  std::vector<WaterAtDepth> column_at(double north_m, double east_m, double time_s) const;
  // Returns the water at all levels, smooth along rows and columns: cubic Hermite polynomials whose slope at
  // a point is that of the parabola through it and its two neighbours, at the first and last point that of
  // the straight line. Clamped to the range of the 16 points used.
  std::vector<WaterAtDepth> smooth_column_at(double north_m, double east_m, double time_s) const;

  // Returns bounds on all water at a depth at any position and time, with linear or smooth interpolation, for
  // a field with water.
  WaterRange extremes_at(double depth_m) const;

  // Returns where the straight line between two positions crosses rows, columns or levels of the grid:
  // fractions of the line in (0, 1), rising.
  std::vector<double> crossings(const Vec3& from, const Vec3& to) const;

  // Conversions that the reader applied beyond those of units, a sentence each.
  const std::vector<std::string>& remarks() const { return remarks_; }

  // Hash of axes and values: equal fields have equal hashes.
  std::uint64_t hash() const { return hash_; }

 private:
  // Interval of an axis that contains a value.
  struct Bracket {
    std::size_t low = 0, high = 0;
    double share = 0;  // from low to high, 0..1
  };
  struct GeodeticPlace {
    double latitude_rad, longitude_rad;
  };
  // Four grid points around a position, and their weights.
  struct Corners {
    std::size_t at[4];
    double weight[4];
  };
  // Four consecutive points of an axis, two on either side of a value, and their weights.
  struct Stencil {
    std::size_t at[4];
    double weight[4];
  };
  static Stencil stencil(const std::vector<double>& axis, double value);
  static Bracket bracket(const std::vector<double>& axis, double value);
  GeodeticPlace geodetic(double north_m, double east_m) const;
  Corners corners(const GeodeticPlace& place) const;
  double at_level(const std::vector<float>& values, const Corners& corners, const Bracket& time,
                  std::size_t depth) const;
  double at(const std::vector<float>& values, const Corners& corners, const Bracket& time,
            const Bracket& depth) const;

  OceanGrid grid_;
  OceanValues values_;
  std::vector<WaterRange> extremes_;  // for each level, over all times
  GeodeticOrigin origin_;
  double meridional_radius_m_, transverse_radius_m_;  // radii of curvature at the origin
  std::uint64_t hash_ = 0;
  std::vector<std::string> remarks_;
};

}  // namespace halocline::ocean
