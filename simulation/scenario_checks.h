// SPDX-License-Identifier: BSD-3-Clause
// Sanity checks of a scenario: combinations of settings that each section allows but that cannot work
// together.
//
// A setting that is certainly wrong is refused in `file`, whose check_findings() throws all
// refusals together; a setting that may be intended causes a warning. The sections check their own keys
// (visit); the checks here involve several sections, a vehicle model, or the terrain.
//
// Refused: traffic that no modem carries; a pilot whose steering the model lacks or whose speed it does not
// hold; more vehicles than the limit; names of no vehicle; a profile that cannot be read; a start out of the
// water (vehicle_sim/start_checks.h); a waypoint, or a whole survey or circle, below the seabed or in the
// air.
//
// Warnings: keys without effect (ConfigVisitor::when); modems that never receive each other; positions that
// look like degrees; packets that last longer than their period or their slot; times of protocols that do not
// fit the distances; a terrain with posts without depth; missions that leave the terrain or whose tracks run
// into it.
#pragma once

#include <cmath>
#include <cstddef>
#include <string>

#include "bathymetry/rasters/terrain_recipe.h"
#include "bathymetry/terrain/terrain.h"
#include "bus/config/config.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "simulation/composition.h"

namespace halocline::clients {

// Returns a key of the scenario's vehicle with that index.
inline std::string key_of(std::size_t vehicle, const std::string& key) {
  return "vehicle." + std::to_string(vehicle) + "." + key;
}

// Round an allowed limit to hundredths, for a message.
inline double rounded_down(double value) { return std::floor(100 * value) / 100; }
inline double rounded_up(double value) { return std::ceil(100 * value) / 100; }

// Returns the modem of the scenario's vehicle with that index.
const channel_server::VehicleModem& modem_of(const ScenarioConfig& config, std::size_t vehicle);

// Checks vehicles, names and the sound speed profile.
void check_water(const ScenarioConfig& config, bus::ConfigFile& file);

// Checks that each model can do what its pilot demands (pilot_checks.cc).
void check_pilots(const ScenarioConfig& config, bus::ConfigFile& file);

// Warns of settings that are hardly intended: modems that never receive each other, degrees instead of metres
// (intent_checks.cc).
void check_intent(const ScenarioConfig& config, bus::ConfigFile& file);

// Checks the times of a network's protocol (network_checks.cc).
void check_network(const ScenarioConfig& config, bus::ConfigFile& file);

// Checks pilots, traffic and networks as far as no terrain is needed.
void check_missions(const ScenarioConfig& config, bus::ConfigFile& file);

// Makes the checks that need the terrain (terrain_checks.cc).
void check_on_terrain(const ScenarioConfig& config, const bathymetry::PreparedTerrain& terrain,
                      bus::ConfigFile& file);

}  // namespace halocline::clients
