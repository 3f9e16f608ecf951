// SPDX-License-Identifier: BSD-3-Clause
// Tables of docs/validation.md that tests measure (studies/validate_sea puts them together).
#pragma once

#include <string>
#include <vector>

namespace halocline::testing {

// Prints the row and keeps it as one of the running test's, in the order of calls. `table` names a table of
// studies/validate_sea; the cells are its columns. Throws std::runtime_error where it cannot be kept.
void doc_row(const std::string& table, const std::vector<std::string>& cells);

}  // namespace halocline::testing
