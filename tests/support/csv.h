// SPDX-License-Identifier: BSD-3-Clause
// Reads the comma-separated reference tables of tests/data, for tests.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace halocline::testing {

// One row: its cells by column name. Quoted cells may hold commas.
class CsvRow {
 public:
  CsvRow(std::map<std::string, std::string> cells, int line) : cells_(std::move(cells)), line_(line) {}
  // The cell as text; fails the test (throws) when there is no such column.
  const std::string& text(const std::string& column) const;
  // The cell as a number; throws where the cell is no number.
  double number(const std::string& column) const;
  bool has_number(const std::string& column) const;
  int line() const { return line_; }  // in the file, from 1

 private:
  std::map<std::string, std::string> cells_;
  int line_;
};

// Rows of `path`, relative to tests/data. Throws when the file is missing or holds no row, so that a test
// over its rows cannot pass for lack of rows.
std::vector<CsvRow> read_reference_csv(const std::string& path);

}  // namespace halocline::testing
