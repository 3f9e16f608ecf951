// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/sound_speed_profile.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "acoustics/math/depth_cells.h"
#include "acoustics/math/gauss_legendre.h"
#include "core/check.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

constexpr double kTallestCell = 100;       // m, within the rows of the table
constexpr double kTallestCellBelow = 500;  // m, below the table, where only pressure changes
// Greatest change of temperature in a cell, degC. Relaxation frequencies follow exp(-3052 / T), so absorption
// a f2 f^2 / (f2^2 + f^2) has poles 41 degC off the real axis, and 5 Gauss nodes over 5 degC have an error of
// (2 * 41 / 2.5)^-10.
constexpr double kWarmestCell = 5;

std::string row_name(std::size_t index, const char* what) {
  return "profile row " + std::to_string(index + 1) + ": " + what;
}

template <typename Row>
void require_rising_depths(const std::vector<Row>& rows) {
  require(!rows.empty(), "a profile needs at least one row");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    require_in_range(rows[i].depth_m, 0, kDeepestWater, row_name(i, "depth"), "m");
    require(i == 0 || rows[i].depth_m > rows[i - 1].depth_m,
            row_name(i, "depth ") + std::to_string(rows[i].depth_m) + " m is not below the row before");
  }
}

// Position in a table: the row at or above a depth, and the fraction of the way to the next, 0..1. Outside of
// the table it is the first or last row.
struct Place {
  std::size_t row;
  double share;
};

template <typename Row>
Place place_of(const std::vector<Row>& rows, double depth_m) {
  if (depth_m <= rows.front().depth_m) return {0, 0};
  if (depth_m >= rows.back().depth_m) return {rows.size() - 1, 0};
  const auto below = std::upper_bound(rows.begin(), rows.end(), depth_m,
                                      [](double depth, const Row& row) { return depth < row.depth_m; });
  const Row& upper = *(below - 1);
  return {static_cast<std::size_t>(below - rows.begin() - 1),
          (depth_m - upper.depth_m) / (below->depth_m - upper.depth_m)};
}

template <typename Row>
double interpolate(const std::vector<Row>& rows, Place place, double Row::*value) {
  const double upper = rows[place.row].*value;
  return place.share == 0 ? upper : upper + place.share * (rows[place.row + 1].*value - upper);
}

// Adds equal cells from the last boundary to `to`, none taller than `tallest`.
void add_cells(std::vector<double>& boundaries, double to, double tallest) {
  const double from = boundaries.back();
  if (to <= from) return;
  const int count = static_cast<int>(std::ceil((to - from) / tallest));
  for (int i = 1; i <= count; ++i) boundaries.push_back(i == count ? to : from + (to - from) * i / count);
}

constexpr double kMeanLatitude = to_radians(45);  // standard gravity is defined there

// Mean temperature and salinity of all oceans (Levitus 1998, World Ocean Atlas).
std::vector<WaterRow> levitus_1998_rows() {
  return {{0, 17.26, 34.89},   {50, 15.09, 35.01},  {100, 13.3, 35.03}, {150, 11.89, 34.98},
          {250, 9.98, 34.86},  {350, 8.57, 34.76},  {450, 7.39, 34.68}, {550, 6.44, 34.63},
          {750, 5.13, 34.59},  {950, 4.21, 34.61},  {1450, 2.97, 34.7}, {1950, 2.32, 34.74},
          {2450, 1.96, 34.75}, {2950, 1.72, 34.74}, {3950, 1.37, 34.73}};
}

}  // namespace

SoundSpeedProfile SoundSpeedProfile::from_water(std::vector<WaterRow> rows, SoundSpeedModel model,
                                                double latitude_rad) {
  require_rising_depths(rows);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    require_in_range(rows[i].temperature_degc, -5, 45, row_name(i, "temperature"), "degC");
    require_in_range(rows[i].salinity_psu, 0, 50, row_name(i, "salinity"), "psu");
  }
  require_in_range(latitude_rad, -std::numbers::pi / 2, std::numbers::pi / 2, "latitude", "rad");
  SoundSpeedProfile profile;
  profile.kind_ = Kind::kWater;
  profile.model_ = model;
  profile.latitude_rad_ = latitude_rad;
  profile.water_rows_ = std::move(rows);
  profile.build_cells();
  return profile;
}

SoundSpeedProfile SoundSpeedProfile::from_speeds(std::vector<SpeedRow> rows, WaterSample assumed) {
  require_rising_depths(rows);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    require_in_range(rows[i].sound_speed_mps, 1000, 2000, row_name(i, "sound speed"), "m/s");
  }
  require_in_range(assumed.temperature_degc, -5, 45, "assumed temperature", "degC");
  require_in_range(assumed.salinity_psu, 0, 50, "assumed salinity", "psu");
  SoundSpeedProfile profile;
  profile.kind_ = Kind::kSpeeds;
  profile.speed_rows_ = std::move(rows);
  profile.assumed_ = assumed;
  profile.build_cells();
  return profile;
}

SoundSpeedProfile SoundSpeedProfile::munk(WaterSample assumed) {
  SoundSpeedProfile profile;
  profile.kind_ = Kind::kMunk;
  profile.assumed_ = assumed;
  profile.build_cells();
  return profile;
}

SoundSpeedProfile SoundSpeedProfile::isovelocity(double sound_speed_mps, WaterSample assumed) {
  return from_speeds({{0, sound_speed_mps}}, assumed);
}

SoundSpeedProfile SoundSpeedProfile::with_change(std::vector<SpeedRow> change) const {
  if (!change.empty()) require_rising_depths(change);
  SoundSpeedProfile changed = *this;
  changed.change_rows_ = std::move(change);
  changed.build_cells();
  return changed;
}

std::vector<double> SoundSpeedProfile::row_depths_m() const {
  std::vector<double> depths;
  for (const WaterRow& row : water_rows_) depths.push_back(row.depth_m);
  for (const SpeedRow& row : speed_rows_) depths.push_back(row.depth_m);
  if (change_rows_.empty()) return depths;
  for (const SpeedRow& row : change_rows_) depths.push_back(row.depth_m);
  std::sort(depths.begin(), depths.end());
  depths.erase(std::unique(depths.begin(), depths.end()), depths.end());
  return depths;
}

void SoundSpeedProfile::build_cells() {
  boundaries_m_ = {0};
  for (const double depth : row_depths_m()) {
    const double warmer =
        std::abs(water(depth).temperature_degc - water(boundaries_m_.back()).temperature_degc);
    const double height = depth - boundaries_m_.back();
    add_cells(boundaries_m_, depth, std::min(kTallestCell, height * kWarmestCell / warmer));
  }
  add_cells(boundaries_m_, kDeepestWater, kTallestCellBelow);
  const auto slowness = [this](double z) { return 1 / sound_speed_mps(z); };
  slowness_to_boundary_ = {0};
  for (std::size_t i = 1; i < boundaries_m_.size(); ++i) {
    const double cell = integrate(gauss_legendre_5(), boundaries_m_[i - 1], boundaries_m_[i], slowness);
    slowness_to_boundary_.push_back(slowness_to_boundary_.back() + cell);
  }
}

double SoundSpeedProfile::sound_speed_mps(double depth_m) const {
  const double z = std::max(depth_m, 0.0), speed = unchanged_speed_mps(z);
  return change_rows_.empty() ? speed : speed + change_mps(z);
}

double SoundSpeedProfile::change_mps(double z) const {
  if (change_rows_.empty() || z >= change_rows_.back().depth_m) return 0;
  return interpolate(change_rows_, place_of(change_rows_, z), &SpeedRow::sound_speed_mps);
}

double SoundSpeedProfile::unchanged_speed_mps(double z) const {
  if (kind_ == Kind::kMunk) return munk_sound_speed_mps(z);
  if (kind_ == Kind::kSpeeds) {
    return interpolate(speed_rows_, place_of(speed_rows_, z), &SpeedRow::sound_speed_mps);
  }
  const WaterSample here = water(z);
  return acoustics::sound_speed_mps(model_, here.temperature_degc, here.salinity_psu, z, latitude_rad_);
}

WaterSample SoundSpeedProfile::water(double depth_m) const {
  if (kind_ != Kind::kWater) return assumed_;
  const Place place = place_of(water_rows_, depth_m);
  return {interpolate(water_rows_, place, &WaterRow::temperature_degc),
          interpolate(water_rows_, place, &WaterRow::salinity_psu)};
}

double SoundSpeedProfile::slowness_integral(double from_depth_m, double to_depth_m) const {
  const auto slowness = [this](double z) { return 1 / sound_speed_mps(z); };
  const DepthSpan span = split_span(boundaries_m_, from_depth_m, to_depth_m);
  double sum = integrate(gauss_legendre_5(), span.head_from_m, span.head_to_m, slowness);
  if (!span.crosses) return sum;
  sum += integrate(gauss_legendre_5(), span.tail_from_m, span.tail_to_m, slowness);
  return sum + (slowness_to_boundary_[span.last_boundary] - slowness_to_boundary_[span.first_boundary]);
}

double SoundSpeedProfile::travel_time_s(double from_depth_m, double to_depth_m, double path_length_m) const {
  const double z1 = std::clamp(std::min(from_depth_m, to_depth_m), 0.0, kDeepestWater);
  const double z2 = std::clamp(std::max(from_depth_m, to_depth_m), 0.0, kDeepestWater);
  // Along a straight line ds / dz = L / (z2 - z1), hence
  //   t = L / (z2 - z1) * integral of dz / c(z) from z1 to z2.
  if (z1 == z2) return path_length_m / sound_speed_mps(z1);
  return path_length_m * (slowness_integral(z1, z2) / (z2 - z1));
}

double SoundSpeedProfile::mean_sound_speed_mps(double from_depth_m, double to_depth_m) const {
  return 1 / travel_time_s(from_depth_m, to_depth_m, 1);
}

double munk_sound_speed_mps(double depth_m) {
  // Munk 1974 (JASA 55, 220): c = c1 (1 + eps (n - 1 + e^-n)), n = 2 (z - z1) / B.
  constexpr double kAxisSpeed = 1500, kAxisDepth = 1300, kScale = 1300, kPerturbation = 0.00737;
  const double n = 2 * (depth_m - kAxisDepth) / kScale;
  return kAxisSpeed * (1 + kPerturbation * (n - 1 + elementary::exp(-n)));
}

SoundSpeedProfile SoundSpeedProfile::global_mean(SoundSpeedModel model) {
  return from_water(levitus_1998_rows(), model, kMeanLatitude);
}

SoundSpeedProfile SoundSpeedProfile::global_mean_of_salinity_35(SoundSpeedModel model) {
  std::vector<WaterRow> rows = levitus_1998_rows();
  for (WaterRow& row : rows) row.salinity_psu = 35;
  return from_water(std::move(rows), model, kMeanLatitude);
}

SoundSpeedProfile SoundSpeedProfile::harris_zorzi(SoundSpeedModel model) {
  // The published slope below 1000 m is rounded, 4.57139 - 5.7142e-4 z: it begins 3e-5 degC below the 4 degC
  // at which the slope above ends. A row just below 1000 m keeps that step, because published delays contain
  // it.
  const double just_below_1000_m = std::nextafter(1000.0, kDeepestWater);
  const double start_of_deep_slope = 4.57139 - 5.7142e-4 * 1000;
  return from_water({{0, 22, 35},
                     {250, 22, 35},
                     {750, 8, 35},
                     {1000, 4, 35},
                     {just_below_1000_m, start_of_deep_slope, 35},
                     {4500, 2, 35}},
                    model, kMeanLatitude);
}

std::optional<SoundSpeedProfile> built_in_profile(std::string_view name, std::optional<SoundSpeedModel> model,
                                                  WaterSample assumed) {
  const SoundSpeedModel speed = model.value_or(SoundSpeedModel::kMackenzie1981);
  if (name == "global-mean") return SoundSpeedProfile::global_mean(speed);
  if (name == "global-mean-s35") return SoundSpeedProfile::global_mean_of_salinity_35(speed);
  if (name == "harris-zorzi") {
    return SoundSpeedProfile::harris_zorzi(model.value_or(SoundSpeedModel::kHarrisZorzi2007));
  }
  if (name == "munk") return SoundSpeedProfile::munk(assumed);
  return std::nullopt;
}

}  // namespace halocline::acoustics
