// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/modem/beam_pattern.h"

#include <algorithm>
#include <numbers>
#include <string>

#include "core/check.h"
#include "core/elementary.h"

namespace halocline::acoustics {

BeamPattern::BeamPattern(std::vector<BeamRow> rows) : rows_(std::move(rows)) {
  require(!rows_.empty(), "a beam pattern needs at least one row; omnidirectional needs no table");
  require(rows_.size() <= kMaxBeamRows, "a beam pattern has " + std::to_string(rows_.size()) +
                                            " rows; allowed is at most " + std::to_string(kMaxBeamRows));
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const std::string row = "beam pattern row " + std::to_string(i + 1) + ": ";
    require_in_range(rows_[i].elevation_rad, -std::numbers::pi / 2, std::numbers::pi / 2, row + "elevation",
                     "rad");
    require_in_range(rows_[i].loss_db, -60, 200, row + "loss", "dB");
    require(i == 0 || rows_[i].elevation_rad > rows_[i - 1].elevation_rad, row + "elevation does not rise");
  }
}

Decibels BeamPattern::loss(double elevation_rad) const {
  if (rows_.empty()) return {0};
  const auto above =
      std::upper_bound(rows_.begin(), rows_.end(), elevation_rad,
                       [](double angle, const BeamRow& row) { return angle < row.elevation_rad; });
  if (above == rows_.begin()) return {rows_.front().loss_db};
  if (above == rows_.end()) return {rows_.back().loss_db};
  const BeamRow& below = *(above - 1);
  // Linear interpolation in decibels between two rows.
  const double share = (elevation_rad - below.elevation_rad) / (above->elevation_rad - below.elevation_rad);
  return {below.loss_db + share * (above->loss_db - below.loss_db)};
}

double BeamPattern::factor(double elevation_rad) const {
  // The factor on pressure is 10^(-loss / 20).
  return rows_.empty() ? 1 : elementary::exp10(-loss(elevation_rad).value / 20);
}

}  // namespace halocline::acoustics
