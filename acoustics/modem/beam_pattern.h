// SPDX-License-Identifier: BSD-3-Clause
// Beam pattern of a transducer in the vertical plane, the same in transmission and reception.
//
// Model: a table of loss against elevation, linear in decibels between rows, constant beyond the ends; no
// table is omnidirectional. Elevation is the angle from the horizontal, positive down (as launch angles are);
// the pattern is the same all around the vertical. Left out: bearing, the tilt of the vehicle (the caller may
// turn the angles), the frequency.
#pragma once

#include <cstddef>
#include <vector>

#include "core/units.h"

namespace halocline::acoustics {

// A row a degree, from straight up to straight down.
inline constexpr std::size_t kMaxBeamRows = 181;

struct BeamRow {
  double elevation_rad;  // -pi/2..pi/2, rising
  double loss_db;        // re the direction to which the source level refers, -60..200
  bool operator==(const BeamRow&) const = default;
};

class BeamPattern {
 public:
  BeamPattern() = default;  // omnidirectional
  // 1..kMaxBeamRows rows. Throws InvalidArgument, naming the row, unless rows are in range and rise.
  explicit BeamPattern(std::vector<BeamRow> rows);

  Decibels loss(double elevation_rad) const;
  // On pressure: 10^(-loss/20).
  double factor(double elevation_rad) const;
  const std::vector<BeamRow>& rows() const { return rows_; }
  bool operator==(const BeamPattern&) const = default;

 private:
  std::vector<BeamRow> rows_;
};

}  // namespace halocline::acoustics
