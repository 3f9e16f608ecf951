// SPDX-License-Identifier: BSD-3-Clause
// Sound speed, temperature and salinity against depth, and the travel time along a straight path through
// them.
//
// Model: a table of depth, temperature and salinity is linear in temperature and in salinity between its
// rows; speed is the chosen formula on the interpolated water at that very depth. (Interpolating speed
// instead is off by up to 5e-4 where rows are far apart; the reference delays decide for temperature and
// salinity, to 1e-15.) Above the first and below the last row temperature and salinity stay constant while
// pressure goes on growing. A table of depth and speed is linear in speed and constant outside of its rows.
// Munk's profile is its formula. Travel time is the integral of ds / c(z): Gauss-Legendre over each layer,
// relative error below 1e-14.
//
//   const auto water = SoundSpeedProfile::global_mean();
//   const double delay_s = water.travel_time_s(100, 900, std::hypot(2000, 800));
//
// Depths are below the sea surface, m; above it (negative) the water of the surface is used. Immutable: calls
// may overlap between threads. Left out: change with place and time, bending of the path (the ray model's
// business).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "acoustics/sea/sound_speed.h"
#include "core/elementary.h"

namespace halocline::acoustics {

inline constexpr double kDeepestWater = 12'000;  // m, below every trench; tables may not go deeper

struct WaterRow {
  double depth_m;           // 0..12 000, rising
  double temperature_degc;  // -5..45 (ITS-90; conservative temperature with TEOS-10)
  double salinity_psu;      // 0..50 (absolute salinity, g/kg, with TEOS-10)
};

struct SpeedRow {
  double depth_m;          // 0..12 000, rising
  double sound_speed_mps;  // 1000..2000
};

// Water at one depth.
struct WaterSample {
  double temperature_degc;
  double salinity_psu;
};

class SoundSpeedProfile {
 public:
  // At least one row, depths strictly rising; throws InvalidArgument that names the row otherwise.
  // `latitude_rad`
  // (-pi/2..pi/2) matters to the models of pressure only.
  static SoundSpeedProfile from_water(std::vector<WaterRow> rows, SoundSpeedModel model, double latitude_rad);
  // A table of speeds has no temperature and salinity, which absorption needs: `assumed`
  // everywhere.
  static SoundSpeedProfile from_speeds(std::vector<SpeedRow> rows, WaterSample assumed);

  // Levitus 1998 (World Ocean Atlas 98), mean of all oceans, 15 rows to 3950 m.
  static SoundSpeedProfile global_mean(SoundSpeedModel model = SoundSpeedModel::kMackenzie1981);
  // The same temperatures with salinity 35 everywhere.
  static SoundSpeedProfile global_mean_of_salinity_35(
      SoundSpeedModel model = SoundSpeedModel::kMackenzie1981);
  // Harris and Zorzi 2007: 22 degC down to 250 m, falling to 8 at 750, 4 at 1000, 2 at 4500; salinity 35.
  static SoundSpeedProfile harris_zorzi(SoundSpeedModel model = SoundSpeedModel::kHarrisZorzi2007);
  // Munk 1974: see munk_sound_speed_mps.
  static SoundSpeedProfile munk(WaterSample assumed);
  static SoundSpeedProfile isovelocity(double sound_speed_mps, WaterSample assumed);

  double sound_speed_mps(double depth_m) const;
  WaterSample water(double depth_m) const;

  // Seconds along a straight path of `path_length_m` >= 0 between two depths, which may be equal and in any
  // order.
  double travel_time_s(double from_depth_m, double to_depth_m, double path_length_m) const;
  // path_length_m / travel_time_s of such a path.
  double mean_sound_speed_mps(double from_depth_m, double to_depth_m) const;

  // Depths, m, rising from 0 to 12 000, between which everything here is smooth: quadrature of any property
  // of the water needs 5 nodes a cell for 1e-12. Rows are among them; cells are at most 100 m tall within the
  // table, and their ends 5 degC apart.
  const std::vector<double>& cell_boundaries_m() const { return boundaries_m_; }
  // The depths of the table's rows, m; empty for Munk's formula.
  std::vector<double> row_depths_m() const;
  SoundSpeedModel model() const { return model_; }
  bool knows_water() const { return kind_ == Kind::kWater; }  // false: temperature and salinity are assumed

 private:
  enum class Kind { kWater, kSpeeds, kMunk };
  SoundSpeedProfile() = default;
  void build_cells();
  double slowness_integral(double from_depth_m, double to_depth_m) const;

  Kind kind_ = Kind::kWater;
  SoundSpeedModel model_ = SoundSpeedModel::kMackenzie1981;
  double latitude_rad_ = 0;
  std::vector<WaterRow> water_rows_;
  std::vector<SpeedRow> speed_rows_;
  WaterSample assumed_{};
  std::vector<double> boundaries_m_;
  std::vector<double> slowness_to_boundary_;  // integral of dz / c from 0 to each boundary, s
};

// A profile that ships, by name: "global-mean", "global-mean-s35", "harris-zorzi", "munk". Empty for any
// other name. `model` overrides the formula that a profile prefers; `assumed` is the water of those that hold
// speeds alone.
std::optional<SoundSpeedProfile> built_in_profile(std::string_view name, std::optional<SoundSpeedModel> model,
                                                  WaterSample assumed);

// Munk 1974 (JASA 55, 220): c = 1500 [1 + 0.00737 (n - 1 + e^-n)], n = 2 (z - 1300) / 1300. Depth 0..5000 m.
double munk_sound_speed_mps(double depth_m);

}  // namespace halocline::acoustics
