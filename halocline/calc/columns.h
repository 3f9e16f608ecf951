// SPDX-License-Identifier: BSD-3-Clause
// Input columns that several quantities share, with their allowed ranges, and their conversion.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "acoustics/sea/absorption.h"
#include "halocline/calc/quantity.h"

namespace halocline::clients {

// Marks an optional column whose value is derived from others when it is missing.
inline constexpr double kDerived = std::numeric_limits<double>::quiet_NaN();

// Returns the same column as an optional one with a default value.
InputColumn or_else(InputColumn column, double value);

// Returns a fixed value that takes a place in a row without a column, for formulas that do not use it.
InputColumn unread(double value);

InputColumn frequency_column(const std::string& name);  // kHz, above 0
InputColumn temperature_column(const std::string& name);
InputColumn salinity_column();
InputColumn depth_column(const std::string& name);
InputColumn range_column();
InputColumn source_level_column();
InputColumn spreading_column();  // default 1.5
InputColumn shipping_column();   // default 0.5
InputColumn wind_column();       // default 0
InputColumn latitude_column();   // default 45

// Columns that absorption may depend on, in the order T_degC, S_ppt, depth_m, P_atm, pH, and the water made
// from their values. A formula reads only the columns that it uses: Fisher and Simmons neither salinity nor
// pH, Thorp none at all. A missing P_atm follows from depth_m at 45 degrees latitude.
std::vector<InputColumn> absorbing_water_columns(acoustics::AbsorptionModel model);
acoustics::AbsorbingWater to_absorbing_water(const std::vector<double>& values, std::size_t first);

std::vector<InputColumn> joined(std::vector<InputColumn> front, const std::vector<InputColumn>& back);

// Returns a form that needs no preparation.
QuantityForm plain(std::string model, std::vector<InputColumn> inputs, std::vector<std::string> outputs,
                   const RowFunction& function);

}  // namespace halocline::clients
