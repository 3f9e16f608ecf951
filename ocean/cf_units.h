// SPDX-License-Identifier: BSD-3-Clause
// Units of measure as they are written in oceanographic files.
//
// The spellings of this field ("degrees C", "psu", "db") come first: UDUNITS reads them as other units or not
// at all. Then the grammar of UDUNITS applies: numbers, names and symbols with SI prefixes, joined by blank,
// ".", "*" or "/", with integer exponents ("m s-1", "m/s", "m s**-1", "100 km", "milliseconds"). Practical
// salinity has no scale: "1", "1e-3" and "psu" all mean the number itself. Months and years are not units
// here because their length depends on the calendar.
//
//   const auto unit = unit_in(QuantityKind::kLength, "km");  // {1000, 0}
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace halocline::ocean {

enum class QuantityKind { kTemperature, kSpeed, kSalinity, kLength, kPressure, kTime, kAngle };

// Conversion of a value of the file to value * factor + offset in degC, m/s, psu, m, dbar, s or degrees.
struct UnitFactor {
  double factor = 1, offset = 0;
  double operator()(double value) const { return value * factor + offset; }
};

// Returns the conversion of a unit; empty when the text is not a unit of the quantity. An empty text is a
// unit of salinity only.
std::optional<UnitFactor> unit_in(QuantityKind quantity, std::string_view text);

// Direction in which degrees count, as in "degrees_north" and "degreeE".
enum class Direction { kUnknown, kNorth, kEast };
Direction direction_in(std::string_view text);

// Returns the allowed units for error messages: "m, km, ft and other units of length".
std::string allowed_units(QuantityKind quantity);

}  // namespace halocline::ocean
