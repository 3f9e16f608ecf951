// SPDX-License-Identifier: BSD-3-Clause
#include "halocline/calc/published.h"

#include "acoustics/sea/absorption.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/sound_speed.h"

namespace halocline::clients {
namespace {

using acoustics::PublishedRange;

// The kilogram-force per square centimetre in decibar.
constexpr double kHzPerKhz = 1000, kDecibarPerKilogram = 9.80665;

PublishedRange in_units_of(const PublishedRange& range, double unit) {
  return {range.lowest / unit, range.highest / unit};
}

bool is_frequency(const std::string& column) { return column.starts_with("f_"); }
bool is_temperature(const std::string& column) { return column.starts_with("T") && column.ends_with("degC"); }

PublishedRange of_speed(acoustics::SoundSpeedModel model, const std::string& column) {
  const acoustics::PublishedWater range = published_water(model);
  if (is_temperature(column) || column == "CT_degC") return range.temperature_degc;
  if (column.starts_with("S")) return range.salinity_psu;
  if (column.starts_with("depth")) return range.depth_m;
  if (column == "p_dbar") return range.pressure_dbar;
  if (column == "P_kg_per_cm2") return in_units_of(range.pressure_dbar, kDecibarPerKilogram);
  return {};
}

PublishedRange of_absorption(acoustics::AbsorptionModel model, const std::string& column) {
  const acoustics::PublishedAbsorption range = published_absorption(model);
  if (is_frequency(column)) return in_units_of(range.frequency_hz, kHzPerKhz);
  if (is_temperature(column)) return range.temperature_degc;
  if (column.starts_with("S_")) return range.salinity_psu;
  if (column == "depth_m") return range.depth_m;
  if (column == "pH") return range.ph;
  return {};
}

}  // namespace

PublishedRange published_range(const std::string& quantity, const std::string& model,
                               const std::string& column) {
  if (quantity == "munk") return acoustics::kPublishedMunkDepthM;
  if (quantity == "depth" && column == "p_dbar") return {0, 10'000};
  if (quantity.starts_with("noise") && is_frequency(column))
    return in_units_of(acoustics::kPublishedNoiseHz, kHzPerKhz);
  if (const auto surface = acoustics::surface_model_from_name(model); surface && is_frequency(column))
    return in_units_of(acoustics::published_surface_loss_hz(*surface), kHzPerKhz);
  if (const auto speed = acoustics::sound_speed_model_from_name(model)) return of_speed(*speed, column);
  if (const auto absorption = acoustics::absorption_model_from_name(model))
    return of_absorption(*absorption, column);
  return {};
}

}  // namespace halocline::clients
