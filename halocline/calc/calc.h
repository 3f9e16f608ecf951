// SPDX-License-Identifier: BSD-3-Clause
// Calculator of `halocline calc`: reads a table and writes it with computed columns appended.
//
// Rows keep their order and columns their text. A result whose column already exists is written as
// `computed_<name>`, so that a reference table is returned with both side by side. Numbers are written in the
// shortest form that reads back as the same double. All bad cells are reported in one run, each with its
// line, its column and what is allowed, and then nothing is written. Values outside of the range for which a
// formula was published are computed all the same, with one line of message.
//
//   std::istringstream in("T_degC,S_ppt,depth_m\n25,35,1000\n");
//   const int code = run_calc({.quantity = "sound-speed"}, in, std::cout, std::cerr);
//   // T_degC,S_ppt,depth_m,c_m_per_s
//   // 25,35,1000,1550.7440275
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "halocline/calc/quantity.h"

namespace halocline::clients {

inline constexpr int kCalcDone = 0;
inline constexpr int kCalcBadTable = 1;    // wrong table: missing columns, bad cells
inline constexpr int kCalcBadRequest = 2;  // wrong options: unknown quantity, model or profile

// Computes options.quantity for every row of `in`. With options.list it describes the quantities (all, or the
// one named) and reads nothing. Messages go to `err`, one per line. Returns one of the codes above.
[[nodiscard]] int run_calc(const CalcOptions& options, std::istream& in, std::ostream& out,
                           std::ostream& err);

// Return the names of all quantities, and of the models of one (empty for an unknown quantity), for help and
// completion.
std::vector<std::string> quantity_names();
std::vector<std::string> model_names(const std::string& quantity);

}  // namespace halocline::clients
