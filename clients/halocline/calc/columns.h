// SPDX-License-Identifier: BSD-3-Clause
// The columns that several quantities read, with the ranges that are allowed, and what they mean inside.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "acoustics/sea/absorption.h"
#include "clients/halocline/calc/quantity.h"

namespace halocline::clients {

// Stands for "no such column" where a value is then derived from others.
inline constexpr double kDerived = std::numeric_limits<double>::quiet_NaN();

// The same column, but optional.
InputColumn or_else(InputColumn column, double value);

// A value that takes its place in a row but that no column gives: a formula that does not know of it.
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

// The five values that absorption may depend on, in the order T_degC, S_ppt, depth_m, P_atm, pH, and the
// water they make. A formula reads the columns it knows of: Fisher and Simmons have no salinity and no pH,
// Thorp nothing at all. P_atm, where it is not given, follows from depth_m at 45 degrees.
std::vector<InputColumn> absorbing_water_columns(acoustics::AbsorptionModel model);
acoustics::AbsorbingWater to_absorbing_water(const std::vector<double>& values, std::size_t first);

// `front` followed by `back`.
std::vector<InputColumn> joined(std::vector<InputColumn> front, const std::vector<InputColumn>& back);

// A form that needs no preparation.
QuantityForm plain(std::string model, std::vector<InputColumn> inputs, std::vector<std::string> outputs,
                   const RowFunction& function);

}  // namespace halocline::clients
