// SPDX-License-Identifier: BSD-3-Clause
// Coverage map: how well receivers over an area, at several depths, receive from one vehicle or position.
//
// Model. Each cell and depth is the link from `from` to a receiver with the scenario's modem at rest at the
// middle of the cell, computed as by `halocline link` (scenario/link_surveyor.h). Over terrain each cell has
// a bottom profile, and links may share rays (RaySharing): either the depths of a cell, or the ranges of a
// bearing. Bearings are so dense that neighbours are one cell apart at the farthest corner. Where the water
// depends on depth only, the terrain is level and no vehicle makes noise, links of equal range are equal, and
// links whose ranges differ by less than a cell are interpolated where that is verified (sampling.h).
//
// Error relative to `halocline link`. Over level terrain it is the tolerance of the interpolation, for the
// quantities asked for: delivery 0.002, level 0.03 dB, delay 0.3 us. Over terrain it is zero without shared
// rays. When depths share rays it is that of their paths (acoustics/rays/depth_fan.h), except in one cell of
// a few hundred, where one of two searches misses a path at a fold or at the edge of a shadow. When ranges
// share rays it is that of acoustics/rays/range_fan.h and of the terrain within half a cell.
// tests/simulation/coverage measures the differences over 1000 random cells.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bathymetry/rasters/terrain_recipe.h"
#include "bathymetry/terrain/terrain.h"
#include "core/for_each.h"
#include "core/frames.h"
#include "simulation/composition.h"
#include "simulation/coverage/coverage_links.h"
#include "simulation/coverage/sampling.h"
#include "simulation/link_survey.h"

namespace halocline::clients {

// Quantities of a map: delivery probability, SNR in dB, level in dB re 1 uPa, delay in s, delivery in one
// hour of ten and in nine (channel_server::LinkForecast).
enum class CoverageQuantity { kDelivery, kSnr, kLevel, kDelay, kDeliveryLow, kDeliveryHigh };

// Description of a quantity for files and pictures.
struct QuantityMeaning {
  CoverageQuantity quantity;
  const char* name;     // name in --quantity and in files
  const char* unit;     // unit as of UDUNITS; 1: dimensionless
  const char* meaning;  // description in words
};
const QuantityMeaning& meaning_of(CoverageQuantity quantity);
// Parses a list such as "delivery,snr". Throws InvalidArgument that states the allowed names for an unknown
// name, an empty list and a name given twice.
std::vector<CoverageQuantity> quantities_of(const std::string& names);

// Square of square cells around a centre, which is the common corner of four cells. `depths_m` are below the
// sea surface, ascending.
struct CoverageArea {
  static constexpr std::size_t kMaxCells = 20'000'000;  // number of cells times depths

  double middle_north_m = 0, middle_east_m = 0, cell_m = 100;
  std::size_t side = 200;  // number of cells along a side, even
  std::vector<double> depths_m;

  double south_m() const { return middle_north_m - 0.5 * static_cast<double>(side) * cell_m; }
  double west_m() const { return middle_east_m - 0.5 * static_cast<double>(side) * cell_m; }
  // Return the middle of a cell, counted from the south-west corner.
  double north_m(std::size_t row) const { return south_m() + (static_cast<double>(row) + 0.5) * cell_m; }
  double east_m(std::size_t column) const { return west_m() + (static_cast<double>(column) + 0.5) * cell_m; }
};
// Parses "5:100:5" as 5, 10, ... 100, or a single depth. Throws InvalidArgument that states what is allowed.
std::vector<double> depths_of(const std::string& text);

// Computed map.
struct Coverage {
  CoverageArea area;
  // Values for each depth, row by row from the south and within a row from the west. NaN where the seabed is
  // unknown or the depth is below it.
  std::vector<std::vector<double>> delivery, level_db, delay_s;
  std::vector<std::vector<double>> delivery_low, delivery_high;  // likewise
  std::vector<std::vector<double>> snr_db;  // likewise; empty: noise_level_db holds in all cells
  double noise_level_db = 0;                // of the ambient noise, over the band of the modem
  // Number of cells beyond the terrain and where it has no data: the last depth is held there, or with
  // propagation.beyond = "none" they have no value.
  std::size_t cells_beyond_terrain = 0;

  // Returns the values of a quantity at the depth with that index. SNR is the level minus that of the ambient
  // noise and the noise of vehicles.
  std::vector<double> values(CoverageQuantity quantity, std::size_t depth) const;
  // Returns the mean delivery over the cells that have water at that depth; empty when none has.
  std::optional<double> mean_delivery(std::size_t depth) const;
  // Returns the index of the depth with the greatest mean delivery; empty when there is no water at all.
  std::optional<std::size_t> best_depth() const;
};

// Returns z of a terrain that is level everywhere, beyond its grids too, m; empty for any other terrain.
// `recipe`: that of the terrain.
std::optional<double> level_z_m(const bathymetry::TerrainRecipe& recipe, const bathymetry::Terrain& terrain);

// Computes the map with `threads` threads. Throws InvalidArgument when `from` is inside the seabed.
Coverage compute_coverage(const ScenarioConfig& config,
                          const std::shared_ptr<const bathymetry::Terrain>& terrain,
                          const LinkSurveyEnd& from, const CoverageArea& area,
                          const std::vector<CoverageQuantity>& wanted, int threads,
                          RaySharing sharing = RaySharing::kNone);

}  // namespace halocline::clients
