// SPDX-License-Identifier: BSD-3-Clause
// The calculator behind `halocline calc`: a table in, the same table with computed columns appended out.
//
// Rows keep their order, columns their text. A result whose column is already there is written as
// `computed_<name>`, so that a reference table comes back with both side by side. Numbers are written in the
// shortest form that reads back as the same double. Every bad cell is reported with line, column and what is
// allowed, all in one run, and then nothing is written. Values beyond the range for which a formula was
// published are computed all the same; one line of messages says so.
//
//   std::istringstream in("T_degC,S_ppt,depth_m\n25,35,1000\n");
//   const int code = run_calc({.quantity = "sound-speed"}, in, std::cout, std::cerr);
//   // T_degC,S_ppt,depth_m,c_m_per_s
//   // 25,35,1000,1550.7440275
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "clients/halocline/calc/quantity.h"

namespace halocline::clients {

inline constexpr int kCalcDone = 0;
inline constexpr int kCalcBadTable = 1;    // the table: missing columns, bad cells
inline constexpr int kCalcBadRequest = 2;  // the options: no such quantity, model or profile

// Computes options.quantity for every row of `in`. With options.list describes the quantities instead (all,
// or the one named) and does not read. Messages go to `err`, one a line. Returns one of the codes above.
[[nodiscard]] int run_calc(const CalcOptions& options, std::istream& in, std::ostream& out,
                           std::ostream& err);

// Names of all quantities, and the models of one (empty when there is no such quantity): for help and
// completion.
std::vector<std::string> quantity_names();
std::vector<std::string> model_names(const std::string& quantity);

}  // namespace halocline::clients
