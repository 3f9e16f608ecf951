// SPDX-License-Identifier: BSD-3-Clause
// Beam pattern of a transducer in the vertical plane, equal in transmission and reception.
//
// Model: a table of loss over elevation, linear in decibels between rows and constant beyond the ends; an
// empty table is omnidirectional. Elevation is the angle from the horizontal, positive down (like launch
// angles). The pattern is rotationally symmetric about the vertical. Left out: bearing, the tilt of the
// vehicle (the caller may rotate the angles), frequency.
#pragma once

#include <cstddef>
#include <vector>

#include "core/units.h"

namespace halocline::acoustics {

// Maximum number of rows: one per degree, from straight up to straight down.
inline constexpr std::size_t kMaxBeamRows = 181;

// Loss in one direction.
struct BeamRow {
  double elevation_rad;  // -pi/2..pi/2, ascending
  double loss_db;        // dB, -60..200, re the direction to which the source level refers
  bool operator==(const BeamRow&) const = default;
};

// Loss of a transducer over elevation.
class BeamPattern {
 public:
  BeamPattern() = default;  // omnidirectional
  // 1..kMaxBeamRows rows. Throws InvalidArgument, naming the row, unless values are in range and elevations
  // increase.
  explicit BeamPattern(std::vector<BeamRow> rows);

  Decibels loss(double elevation_rad) const;
  // Factor on pressure: 10^(-loss/20).
  double factor(double elevation_rad) const;
  const std::vector<BeamRow>& rows() const { return rows_; }
  bool operator==(const BeamPattern&) const = default;

 private:
  std::vector<BeamRow> rows_;
};

}  // namespace halocline::acoustics
