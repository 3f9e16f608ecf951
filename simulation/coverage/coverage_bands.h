// SPDX-License-Identifier: BSD-3-Clause
// Maps of 10, 50 and 90 % over the members of an ensemble (simulation/ensemble/sea_member.h), cell by cell
// and quantity by quantity: the map of 10 % is no member's.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>

#include "bathymetry/terrain/terrain.h"
#include "simulation/composition.h"
#include "simulation/coverage/coverage.h"
#include "simulation/link_survey.h"

namespace halocline::clients {

using CoverageBands = std::array<Coverage, 3>;  // in the order of kBandShares

// Computes the maps of `members` (at least 1) seas with `computed` and returns the three of their quantiles,
// all of them with an SNR of each cell. All members' maps are in memory at once.
CoverageBands coverage_bands(const ScenarioConfig& config, const LinkSurveyEnd& from,
                             const bathymetry::Terrain& terrain, std::size_t members,
                             const std::function<Coverage(const ScenarioConfig&)>& computed);

// Returns the name of the i-th file: "map.tif" becomes "map.10.tif", "map.50.tif", "map.90.tif".
std::string name_of_band(const std::string& path, std::size_t i);

}  // namespace halocline::clients
