// SPDX-License-Identifier: BSD-3-Clause
// One axis of a CF netCDF file: its kind and its values. The conventions are those of ocean/cf_grid.h.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "ocean/cf_units.h"
#include "ocean/netcdf_file.h"

namespace halocline::ocean {

enum class AxisKind { kTime, kDepth, kLatitude, kLongitude, kOther };

struct CfAxis {
  std::string name = {};            // name of its variable; empty: no variable, one value
  std::string dimension = {};       // name of its dimension; empty: no dimension
  std::vector<double> values = {};  // rising; time in the file's unit, depth in m down, angles in degrees
  std::vector<std::size_t> places = {};  // index of each value along the dimension
};

// Returns the conversion of the variable's units. Throws InvalidArgument that names them and those allowed.
UnitFactor unit_of(const NetcdfFile& file, const std::string& variable, QuantityKind quantity);

// Returns the name of the coordinate variable of a dimension of `variable`: the variable of the dimension's
// name, or one that the attribute `coordinates` names; empty: there is none.
std::string coordinate_of(const NetcdfFile& file, const std::string& variable, const std::string& dimension);

// Returns the words of the attribute `coordinates` that are variables.
std::vector<std::string> auxiliary_coordinates(const NetcdfFile& file, const std::string& variable);

// Returns the kind of an axis. Throws InvalidArgument for terrain-following levels.
AxisKind kind_of(const NetcdfFile& file, const std::string& axis);

// Reads an axis whose `kind` is not kOther; `latitude_deg` is used to convert pressures into depths. Throws
// InvalidArgument when there are no values, when one is missing, and when they are not monotonic.
CfAxis read_axis(const NetcdfFile& file, const std::string& name, AxisKind kind, double latitude_deg);

// Moves the seam of longitudes that span the whole earth to the meridian opposite of `longitude_deg`.
void move_seam(CfAxis& longitudes, double longitude_deg);

// Describes a variable whose positions are given by two-dimensional latitudes and longitudes (a curvilinear
// grid), for error messages: "its places are in two dimensions (...)" with their ranges; empty for other
// variables.
std::string curvilinear_places(const NetcdfFile& file, const std::string& variable);

}  // namespace halocline::ocean
