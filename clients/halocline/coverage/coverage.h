// SPDX-License-Identifier: BSD-3-Clause
// How well a vehicle or a place is heard over an area, at several depths: a map of links from one end.
//
// Model: each cell and depth is the link from `from` to a receiver with the scenario's modem at rest in the
// middle of the cell, computed as `halocline link` does (scenario/link_surveyor.h). Over terrain each cell
// has a bottom profile, and links may share rays (RaySharing): the depths of a cell, or the cells of a
// bearing, of which there are so many that neighbours are a cell apart at the furthest corner. Where the
// water depends on depth alone and the terrain is level, links of one range are the same, and those of ranges
// within a cell are interpolated where that is verified (sampling.h).
//
// Error beside `link`. Over level ground, of what is asked for: delivery 0.002, level 0.03 dB, delay 0.3 us
// as the tolerance of the interpolation. Over terrain none, unless rays are shared: by depths then that of
// paths (acoustics/rays/column_rays.h), but for one cell in some hundred where one of two searches misses a
// path at a fold or the edge of a shadow; by bearings what acoustics/rays/bearings/bearing_rays.h leaves out,
// and the terrain within half a cell. tests/clients/halocline/coverage has what 1000 random cells differ by.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bathymetry/terrain/terrain.h"
#include "clients/halocline/coverage/coverage_links.h"
#include "clients/halocline/coverage/sampling.h"
#include "clients/halocline/scenario/composition.h"
#include "clients/halocline/scenario/link_survey.h"
#include "core/for_each.h"
#include "core/frames.h"

namespace halocline::clients {

enum class CoverageQuantity { kDelivery, kSnr, kLevel, kDelay };

// What is written of it.
struct QuantityMeaning {
  CoverageQuantity quantity;
  const char* name;     // of --quantity and in files
  const char* unit;     // of UDUNITS; 1: a pure number
  const char* meaning;  // what it is
};
const QuantityMeaning& meaning_of(CoverageQuantity quantity);
// "delivery,snr". Throws InvalidArgument, with what is allowed, for other names, for none and for one named
// twice.
std::vector<CoverageQuantity> quantities_of(const std::string& names);

// Square cells about a middle, which is a corner of four; `depths_m` below the sea surface, rising.
struct CoverageArea {
  static constexpr std::size_t kMaxCells = 20'000'000;  // times depths

  double middle_north_m = 0, middle_east_m = 0, cell_m = 100;
  std::size_t side = 200;  // cells, even
  std::vector<double> depths_m;

  double south_m() const { return middle_north_m - 0.5 * static_cast<double>(side) * cell_m; }
  double west_m() const { return middle_east_m - 0.5 * static_cast<double>(side) * cell_m; }
  // Middle of a cell, from the south-west.
  double north_m(std::size_t row) const { return south_m() + (static_cast<double>(row) + 0.5) * cell_m; }
  double east_m(std::size_t column) const { return west_m() + (static_cast<double>(column) + 0.5) * cell_m; }
};
// "5:100:5" as 5, 10, ... 100; or one depth. Throws InvalidArgument, with what is allowed.
std::vector<double> depths_of(const std::string& text);

struct Coverage {
  CoverageArea area;
  // Of each depth, row by row from the south, each from the west. NaN where there is no known seabed or no
  // water.
  std::vector<std::vector<double>> delivery, level_db, delay_s;
  double noise_level_db = 0;  // over the band of the modem

  // At the place of a depth; snr is level less noise.
  std::vector<double> values(CoverageQuantity quantity, std::size_t depth) const;
  // Mean of the delivery over the cells that hold water at that depth; empty where none does.
  std::optional<double> mean_delivery(std::size_t depth) const;
  // The depth of the greatest mean; empty where there is no water at all.
  std::optional<std::size_t> best_depth() const;
};

// z of a terrain that is level everywhere; empty for others.
std::optional<double> level_z_m(const bathymetry::Terrain& terrain);

// Throws InvalidArgument where `from` lies inside the seabed. `threads` share the work.
Coverage compute_coverage(const ScenarioConfig& config,
                          const std::shared_ptr<const bathymetry::Terrain>& terrain,
                          const LinkSurveyEnd& from, const CoverageArea& area,
                          const std::vector<CoverageQuantity>& wanted, int threads,
                          RaySharing sharing = RaySharing::kNone);

}  // namespace halocline::clients
