// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/sources/water_changes.h"

#include <algorithm>
#include <functional>
#include <vector>

namespace halocline::monitor {
namespace {

bool is_uniform(const std::vector<double>& values) {
  return std::adjacent_find(values.begin(), values.end(), std::not_equal_to<>()) == values.end();
}

bool have_one_profile(const environment_t& a, const environment_t& b) {
  return a.layer_depth_m == b.layer_depth_m && a.layer_sound_speed_mps == b.layer_sound_speed_mps &&
         a.layer_temperature_degc == b.layer_temperature_degc && a.layer_salinity_psu == b.layer_salinity_psu;
}

void set_profile(environment_change_t& change, const environment_t& water) {
  // A profile given as sound speeds has the same temperature and salinity in all rows.
  const bool is_of_speeds = is_uniform(water.layer_temperature_degc) && is_uniform(water.layer_salinity_psu);
  change.profile_set =
      is_of_speeds ? environment_change_t::PROFILE_SPEED : environment_change_t::PROFILE_WATER;
  change.num_layers = water.num_layers;
  change.layer_depth_m = water.layer_depth_m;
  change.layer_sound_speed_mps = water.layer_sound_speed_mps;
  change.layer_temperature_degc = water.layer_temperature_degc;
  change.layer_salinity_psu = water.layer_salinity_psu;
}

}  // namespace

std::optional<environment_change_t> change_between(const environment_t& before, const environment_t& after) {
  environment_change_t change{};
  change.sets_wind = before.wind_speed_mps != after.wind_speed_mps ? 1 : 0;
  change.sets_shipping = before.shipping_activity != after.shipping_activity ? 1 : 0;
  change.sets_sea_surface = before.sea_surface_z_m != after.sea_surface_z_m ? 1 : 0;
  change.wind_speed_mps = after.wind_speed_mps;
  change.shipping_activity = after.shipping_activity;
  change.sea_surface_z_m = after.sea_surface_z_m;
  if (!have_one_profile(before, after)) set_profile(change, after);
  const bool changes = change.sets_wind || change.sets_shipping || change.sets_sea_surface ||
                       change.profile_set != environment_change_t::PROFILE_UNCHANGED;
  return changes ? std::optional(change) : std::nullopt;
}

}  // namespace halocline::monitor
