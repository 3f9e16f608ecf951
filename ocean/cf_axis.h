// SPDX-License-Identifier: BSD-3-Clause
// One axis of a CF netCDF file: which kind it is, and its values. The conventions are those of
// ocean/cf_grid.h.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "ocean/cf_units.h"
#include "ocean/netcdf_file.h"

namespace halocline::ocean {

enum class AxisKind { kTime, kDepth, kLatitude, kLongitude, kOther };

struct Axis {
  std::string name = {};                 // of its variable; empty: none, one value
  std::string dimension = {};            // empty: none
  std::vector<double> values = {};       // rising: in the file's unit (time), m down, degrees
  std::vector<std::size_t> places = {};  // of each value along the dimension
};

// The factor of the variable's units; throws InvalidArgument that names them and those allowed.
UnitFactor unit_of(const NetcdfFile& file, const std::string& variable, Quantity quantity);

// Where `variable` is on a dimension: the variable that holds its places, by name or by the attribute
// `coordinates`; empty: none.
std::string coordinate_of(const NetcdfFile& file, const std::string& variable, const std::string& dimension);

// The words of the attribute `coordinates` that are variables.
std::vector<std::string> auxiliary_coordinates(const NetcdfFile& file, const std::string& variable);

// Throws InvalidArgument for levels that follow the terrain.
AxisKind kind_of(const NetcdfFile& file, const std::string& axis);

// Its values: `kind` is no kOther; `latitude_deg` is where pressures become depths. Throws InvalidArgument
// where there are none, one is missing, or they neither rise nor fall.
Axis read_axis(const NetcdfFile& file, const std::string& name, AxisKind kind, double latitude_deg);

// The seam of longitudes that go round the earth is moved to the place opposite of `longitude_deg`.
void move_seam(Axis& longitudes, double longitude_deg);

// Where the places of the variable are in two dimensions: "its latitudes run from ... to ..., its longitudes
// from ..."; else empty.
std::string curvilinear_places(const NetcdfFile& file, const std::string& variable);

}  // namespace halocline::ocean
