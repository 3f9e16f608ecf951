// SPDX-License-Identifier: BSD-3-Clause
// Units of measure as files of the sea write them.
//
// First the spellings that a quantity has in this field ("degrees C", "psu", "db"), which UDUNITS reads as
// something else or not at all; then UDUNITS' grammar: numbers, names and symbols with SI prefixes, joined by
// blank, ".", "*" or "/", with whole exponents ("m s-1", "m/s", "m s**-1", "100 km", "milliseconds").
// Practical salinity has no scale: "1", "1e-3" and "psu" all mean the number itself. Months and years are no
// units here: their length depends on the calendar.
//
//   const auto unit = unit_in(Quantity::kLength, "km");  // {1000, 0}
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace halocline::ocean {

enum class Quantity { kTemperature, kSpeed, kSalinity, kLength, kPressure, kTime, kAngle };

// A value of the file becomes value * factor + offset: degC, m/s, psu, m, dbar, s, degrees.
struct UnitFactor {
  double factor = 1, offset = 0;
  double operator()(double value) const { return value * factor + offset; }
};

// None where the text is no unit of the quantity. An empty text is one of salinity alone.
std::optional<UnitFactor> unit_in(Quantity quantity, std::string_view text);

// Which way degrees count, as "degrees_north" and "degreeE" say.
enum class Direction { kUnknown, kNorth, kEast };
Direction direction_in(std::string_view text);

// For refusals: "m, km, ft and other units of length".
std::string allowed_units(Quantity quantity);

}  // namespace halocline::ocean
