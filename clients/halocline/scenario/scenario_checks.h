// SPDX-License-Identifier: BSD-3-Clause
// Checks of sense: what each section allows and the whole scenario cannot mean.
//
// What is surely wrong is refused in `file`, and thrown by its check_findings() with all else; what may be
// meant is warned of. The sections check their own keys (visit); here is what takes several of them, a model,
// or the terrain.
//
// Refused: traffic that no modem carries, a pilot whose steering the model lacks or whose speed it does not
// hold, more vehicles than are followed, names of no vehicle, a profile that cannot be read, a start out of
// the water (vehicle_sim/start_checks.h), a waypoint, or a whole survey or circle, under ground or in the
// air. Warned of: keys without effect (ConfigVisitor::when), modems that never receive each other, places
// that look like degrees, packets that last longer than their period or their slot, times of protocols that
// the distances do not allow, a terrain with posts without depth, missions that leave the terrain or whose
// tracks the ground cuts.
#pragma once

#include <cmath>
#include <cstddef>
#include <string>

#include "bathymetry/rasters/terrain_recipe.h"
#include "bathymetry/terrain/terrain.h"
#include "bus/config/config.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "clients/halocline/scenario/composition.h"

namespace halocline::clients {

// A key of the scenario's vehicle of that index.
inline std::string key_of(std::size_t vehicle, const std::string& key) {
  return "vehicle." + std::to_string(vehicle) + "." + key;
}

// To hundredths: what is allowed, for a person.
inline double rounded_down(double value) { return std::floor(100 * value) / 100; }
inline double rounded_up(double value) { return std::ceil(100 * value) / 100; }

// Of the scenario's vehicle of that index.
const channel_server::VehicleModem& modem_of(const ScenarioConfig& config, std::size_t vehicle);

// Vehicles, names and the profile.
void check_water(const ScenarioConfig& config, bus::ConfigFile& file);

// Pilots, of what the models have (pilot_checks.cc).
void check_pilots(const ScenarioConfig& config, bus::ConfigFile& file);

// What may hardly be meant: modems that never receive each other, degrees in the place of metres
// (intent_checks.cc).
void check_intent(const ScenarioConfig& config, bus::ConfigFile& file);

// The times of a network's protocol (network_checks.cc).
void check_network(const ScenarioConfig& config, bus::ConfigFile& file);

// Pilots, traffic and networks, as far as no terrain is needed.
void check_missions(const ScenarioConfig& config, bus::ConfigFile& file);

// The rest (terrain_checks.cc).
void check_on_terrain(const ScenarioConfig& config, const bathymetry::PreparedTerrain& terrain,
                      bus::ConfigFile& file);

}  // namespace halocline::clients
