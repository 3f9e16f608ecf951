// SPDX-License-Identifier: BSD-3-Clause
// Grid of a variable in a CF netCDF file: its axes by kind, in any order, and its values on them. Part of the
// module halocline_ocean_fields.so.
//
// The kind of an axis (CF 1.10, chapter 4) follows from the first of these that is conclusive: standard_name;
// units (degrees north and east, "... since ...", pressure); the attribute axis; the attribute positive; its
// name. An axis is the variable with the name of its dimension, or one that `coordinates` names, with that
// dimension alone or with a single value. Axes are monotonic. Refused, with their names and a remedy:
// terrain-following levels, projections, rotated poles, two-dimensional positions, and axes of no known kind
// with more than one value.
//
// Depths are in metres, positive down, converted from any unit of length or from pressure (UNESCO Technical
// Paper 44, at the given latitude); heights change sign. Longitudes are in degrees; a jump of a full turn is
// removed, and where the grid spans the whole earth, its seam is placed opposite of the place of interest.
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
  // `latitude_deg` and `longitude_deg` are those of the place of interest. Throws InvalidArgument.
  CfGrid(const NetcdfFile& file, const std::string& variable, double latitude_deg, double longitude_deg);

  const CfAxis& at(AxisKind kind) const { return axes_[static_cast<std::size_t>(kind)]; }
  double points() const;
  // Keeps only `count` values of an axis, from index `first` on.
  void keep(AxisKind kind, std::size_t first, std::size_t count);
  bool is_as(const CfGrid& other) const;

  // Returns the values of a variable on the same dimensions, [time][depth][latitude][longitude]; NaN:
  // missing.
  std::vector<float> read(const std::string& variable, const UnitFactor& unit) const;

 private:
  struct Box {
    std::vector<std::size_t> from, counts;        // along the variable's dimensions
    std::optional<std::size_t> time;              // index of the time dimension among them
    std::array<std::size_t, 5> steps{}, first{};  // stride in the box and first index, by AxisKind
  };
  CfAxis& axis(AxisKind kind) { return axes_[static_cast<std::size_t>(kind)]; }
  void add(AxisKind kind, CfAxis found);
  void add_scalars(const std::string& variable, double latitude_deg);
  void require_complete(const std::string& variable) const;
  std::vector<AxisKind> kinds_in(const std::string& variable) const;
  Box box_of(const std::string& variable) const;
  [[noreturn]] void refuse_axis(const std::string& variable, const std::string& dimension,
                                const std::string& name) const;
  [[noreturn]] void refuse_other_grid(const std::string& variable) const;

  const NetcdfFile& file_;
  std::array<CfAxis, 4> axes_;  // indexed by AxisKind
};

}  // namespace halocline::ocean
