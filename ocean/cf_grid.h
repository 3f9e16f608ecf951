// SPDX-License-Identifier: BSD-3-Clause
// The grid that a variable of a CF netCDF file is on: its axes by kind, in any order, and its values on them.
// Part of the module halocline_ocean_fields.so.
//
// Kind of an axis (CF 1.10, chapter 4), by the first that tells: standard_name; units (degrees north and
// east, "... since ...", pressure); axis; positive; its name. An axis is the variable of its dimension's
// name, or one that `coordinates` names, on that dimension alone or with a single value. Axes rise or fall.
// Refused with their names and what to do: levels that follow the terrain, projections, rotated poles,
// positions in two dimensions, axes of no kind with more than one value.
//
// Depth is in metres, down, from any unit of length or from pressure (UNESCO Technical Paper 44, at the
// latitude given); heights are turned round. Longitudes are degrees; a jump of a turn is undone, and where
// the grid goes round the earth, the seam lies opposite of the place of interest.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "ocean/cf_axis.h"
#include "ocean/cf_units.h"
#include "ocean/netcdf_file.h"

namespace halocline::ocean {

class CfGrid {
 public:
  // `about`: latitude and longitude of the place of interest, degrees. Throws InvalidArgument.
  CfGrid(const NetcdfFile& file, const std::string& variable, double latitude_deg, double longitude_deg);

  const Axis& at(AxisKind kind) const { return axes_[static_cast<std::size_t>(kind)]; }
  double points() const;
  // Only `count` values of an axis from the one at `first` on.
  void keep(AxisKind kind, std::size_t first, std::size_t count);
  bool is_as(const CfGrid& other) const;

  // Values of a variable on the same dimensions, [time][depth][latitude][longitude]; NaN: missing.
  std::vector<float> read(const std::string& variable, const UnitFactor& unit) const;

 private:
  struct Box {
    std::vector<std::size_t> from, counts;  // along the variable's dimensions
    std::optional<std::size_t> time;        // which of them it is
    std::array<std::size_t, 5> steps{},
        first{};  // by AxisKind: from place to place in what is read, and the first place
  };
  Axis& axis(AxisKind kind) { return axes_[static_cast<std::size_t>(kind)]; }
  void add(AxisKind kind, Axis found);
  void add_scalars(const std::string& variable, double latitude_deg);
  void require_complete(const std::string& variable) const;
  std::vector<AxisKind> kinds_in(const std::string& variable) const;
  Box box_of(const std::string& variable) const;
  [[noreturn]] void refuse_axis(const std::string& variable, const std::string& dimension,
                                const std::string& name) const;
  [[noreturn]] void refuse_other_grid(const std::string& variable) const;

  const NetcdfFile& file_;
  std::array<Axis, 4> axes_;  // by AxisKind
};

}  // namespace halocline::ocean
