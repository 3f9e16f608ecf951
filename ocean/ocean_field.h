// SPDX-License-Identifier: BSD-3-Clause
// Current, temperature and salinity of the ocean as functions of place and time.
//
// Model: values on a grid of time, depth, latitude and longitude, as ocean models (HYCOM, ROMS on levels of
// depth) give them; linear in each of the four between its points. Beyond the first and the last
// time, level, row and column the values there hold. Points without a value, the seabed and land, have
// - below the deepest value of a column, that value, above the highest that one;
// - in a column without any, the column that is fewest steps away along the grid: so currents run along
//   coasts undiminished.
// Vertical currents are left out.
//
// Frames: the world's NED in its flat mode (bathymetry/terrain/local_frame.h), a transverse Mercator
// projection about the origin. Here its inverse to second order: 10 m off at 100 km, at 45 degrees. East and
// north of the file are turned by the meridian's convergence there. Depth is below the sea surface, m, of any
// sign; time is the simulation's, s.
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

// Axes, each rising, of one value or more; angles in radians, longitudes less than a turn apart.
struct OceanGrid {
  std::vector<double> times_s, depths_m, latitudes_rad, longitudes_rad;
  std::size_t levels() const { return times_s.size() * depths_m.size(); }
  std::size_t columns() const { return latitudes_rad.size() * longitudes_rad.size(); }
};

// [time][depth][latitude][longitude]; NaN where the file has no value. Empty: a variable that the file has
// not. Currents come together, as do temperature (in situ, ITS-90) and salinity (practical).
struct OceanValues {
  std::vector<float> east_mps, north_mps;             // -10..10
  std::vector<float> temperature_degc, salinity_psu;  // -5..45, 0..50
};

struct GeodeticOrigin {
  double latitude_rad = 0, longitude_rad = 0;  // of the world's NED, WGS 84
};

struct WaterAtDepth {
  double depth_m, temperature_degc, salinity_psu;
};

// What all water of a layer has, between the values of a field.
struct WaterRange {
  double least_degc, greatest_degc, least_psu, greatest_psu;
};

class OceanField {
 public:
  // Throws InvalidArgument that names the axis or the variable, the value and what is allowed; also when the
  // origin lies outside of the grid or a variable has no value at all at one of its times.
  OceanField(OceanGrid grid, OceanValues values, const GeodeticOrigin& origin,
             std::vector<std::string> remarks = {});

  bool has_current() const { return !values_.east_mps.empty(); }
  bool has_water() const { return !values_.temperature_degc.empty(); }
  bool is_steady() const { return grid_.times_s.size() == 1; }
  const OceanGrid& grid() const { return grid_; }

  // Whether the grid reaches a place.
  bool covers(double north_m, double east_m) const;

  // Of a field that has it. `place`: north, east and depth.
  Vec3 current_ned_mps(const Vec3& place, double time_s) const;
  WaterAtDepth water_at(const Vec3& place, double time_s) const;
  // The same at all levels of the grid.
  std::vector<WaterAtDepth> column_at(double north_m, double east_m, double time_s) const;
  // The same, smooth along rows and columns: cubic Hermite polynomials whose slope at a point is that of the
  // parabola through it and its neighbours, at the first and the last that of the line; within what the
  // points about have.
  std::vector<WaterAtDepth> smooth_column_at(double north_m, double east_m, double time_s) const;

  // All water at a depth at any place and time, smooth or not; of a field that has it.
  WaterRange extremes_at(double depth_m) const;

  // Where the straight way between two places crosses rows, columns or levels of the grid: shares of it in
  // (0, 1), rising.
  std::vector<double> crossings(const Vec3& from, const Vec3& to) const;

  // What its reader did to values beyond their units, a sentence each.
  const std::vector<std::string>& remarks() const { return remarks_; }

  // Of axes and values: the same field has the same.
  std::uint64_t hash() const { return hash_; }

 private:
  // Between two points of an axis.
  struct Bracket {
    std::size_t low = 0, high = 0;
    double share = 0;  // 0..1, from the one to the other
  };
  struct GeodeticPlace {
    double latitude_rad, longitude_rad;
  };
  // The four points about a place and their weights.
  struct Corners {
    std::size_t at[4];
    double weight[4];
  };
  // Those of two more along an axis.
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
  std::vector<WaterRange> extremes_;  // at each level, over all times
  GeodeticOrigin origin_;
  double meridional_radius_m_, transverse_radius_m_;  // of curvature at the origin
  std::uint64_t hash_ = 0;
  std::vector<std::string> remarks_;
};

}  // namespace halocline::ocean
