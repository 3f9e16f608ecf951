// SPDX-License-Identifier: BSD-3-Clause
// Sound speed, temperature and salinity over depth, and the travel time along a straight path.
//
// Model: in a table of depth, temperature and salinity, temperature and salinity are linear between rows; the
// speed at a depth is the chosen formula of the interpolated water. (Interpolating the speed instead is off
// by up to 5e-4 where rows are far apart; the reference delays confirm interpolation of temperature and
// salinity, to 1e-15.) Above the first and below the last row temperature and salinity are constant while
// pressure continues to increase. A table of depth and speed is linear in speed and constant outside of its
// rows. Munk's profile is its formula. Travel time is the integral of ds / c(z) by Gauss-Legendre quadrature
// over each layer, relative error below 1e-14.
//
//   const auto water = SoundSpeedProfile::global_mean();
//   const double delay_s = water.travel_time_s(100, 900, std::hypot(2000, 800));
//
// Depths are below the sea surface, m; at negative depths the water of the surface is used. Immutable: calls
// may overlap between threads. Left out: variation with position and time, refraction (see acoustics/rays).
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "acoustics/sea/sound_speed.h"
#include "core/elementary.h"

namespace halocline::acoustics {

inline constexpr double kDeepestWater = 12'000;  // m, below every trench; tables may not go deeper

// A row of a table of temperature and salinity.
struct WaterRow {
  double depth_m;           // 0..12 000, ascending
  double temperature_degc;  // -5..45 (ITS-90; conservative temperature with TEOS-10)
  double salinity_psu;      // 0..50 (absolute salinity, g/kg, with TEOS-10)
};

// A row of a table of sound speed.
struct SpeedRow {
  double depth_m;          // 0..12 000, ascending
  double sound_speed_mps;  // 1000..2000
};

// Temperature and salinity at one depth.
struct WaterSample {
  double temperature_degc;
  double salinity_psu;
};

// A profile from a table or Munk's formula.
class SoundSpeedProfile {
 public:
  // Makes a profile of one or more rows with strictly ascending depths; otherwise throws InvalidArgument that
  // names the row. `latitude_rad` (-pi/2..pi/2) is used by the models of pressure only.
  static SoundSpeedProfile from_water(std::vector<WaterRow> rows, SoundSpeedModel model, double latitude_rad);
  // A table of speeds lacks the temperature and salinity that absorption needs: `assumed` is used at all
  // depths.
  static SoundSpeedProfile from_speeds(std::vector<SpeedRow> rows, WaterSample assumed);

  // Levitus 1998 (World Ocean Atlas 98), mean of all oceans, 15 rows to 3950 m.
  static SoundSpeedProfile global_mean(SoundSpeedModel model = SoundSpeedModel::kMackenzie1981);
  // The temperatures of global_mean() with salinity 35 at all depths.
  static SoundSpeedProfile global_mean_of_salinity_35(
      SoundSpeedModel model = SoundSpeedModel::kMackenzie1981);
  // Harris and Zorzi 2007: 22 degC down to 250 m, falling to 8 at 750, 4 at 1000, 2 at 4500; salinity 35.
  static SoundSpeedProfile harris_zorzi(SoundSpeedModel model = SoundSpeedModel::kHarrisZorzi2007);
  // Munk 1974: see munk_sound_speed_mps.
  static SoundSpeedProfile munk(WaterSample assumed);
  static SoundSpeedProfile isovelocity(double sound_speed_mps, WaterSample assumed);

  // Return this profile with `change` added to its speeds, and without. `change` holds changes of sound
  // speed, m/s, by depth, rising, linear between its rows, constant above the first and 0 below the last; it
  // replaces an earlier change. Throws InvalidArgument when the depths do not rise.
  SoundSpeedProfile with_change(std::vector<SpeedRow> change) const;
  SoundSpeedProfile without_change() const { return with_change({}); }
  const std::vector<SpeedRow>& change() const { return change_rows_; }  // empty: none
  double change_mps(double depth_m) const;                              // at 0 m or below

  double sound_speed_mps(double depth_m) const;
  WaterSample water(double depth_m) const;

  // Travel time, s, along a straight path of `path_length_m` >= 0 between two depths, equal or in any order.
  double travel_time_s(double from_depth_m, double to_depth_m, double path_length_m) const;
  // Mean speed along such a path, path_length_m / travel_time_s().
  double mean_sound_speed_mps(double from_depth_m, double to_depth_m) const;

  // Ascending depths, m, from 0 to 12 000, between which all properties of the water are smooth: quadrature
  // needs 5 nodes a cell for 1e-12. Rows are included; within the table cells are at most 100 m tall and span
  // at most 5 degC.
  const std::vector<double>& cell_boundaries_m() const { return boundaries_m_; }
  // The depths of the rows of the table and of a change, m; empty for Munk's formula without one.
  std::vector<double> row_depths_m() const;
  SoundSpeedModel model() const { return model_; }
  // True for a table of speeds, which is linear between its rows.
  bool is_table_of_speeds() const { return kind_ == Kind::kSpeeds; }
  // False: temperature and salinity are assumed values.
  bool knows_water() const { return kind_ == Kind::kWater; }

 private:
  enum class Kind { kWater, kSpeeds, kMunk };
  SoundSpeedProfile() = default;
  void build_cells();
  double unchanged_speed_mps(double depth_m) const;  // at 0 m or below
  double slowness_integral(double from_depth_m, double to_depth_m) const;

  Kind kind_ = Kind::kWater;
  SoundSpeedModel model_ = SoundSpeedModel::kMackenzie1981;
  double latitude_rad_ = 0;
  std::vector<WaterRow> water_rows_;
  std::vector<SpeedRow> speed_rows_;
  std::vector<SpeedRow> change_rows_;  // empty: no change
  WaterSample assumed_{};
  std::vector<double> boundaries_m_;
  std::vector<double> slowness_to_boundary_;  // integral of dz / c from 0 to each boundary, s
};

// A built-in profile by name: "global-mean", "global-mean-s35", "harris-zorzi", "munk"; empty for any other
// name. `model` replaces the profile's default formula; `assumed` is the water of profiles that have speeds
// alone.
std::optional<SoundSpeedProfile> built_in_profile(std::string_view name, std::optional<SoundSpeedModel> model,
                                                  WaterSample assumed);

// Munk 1974 (JASA 55, 220): c = 1500 [1 + 0.00737 (n - 1 + e^-n)], n = 2 (z - 1300) / 1300. Depth 0..5000 m.
double munk_sound_speed_mps(double depth_m);

}  // namespace halocline::acoustics
