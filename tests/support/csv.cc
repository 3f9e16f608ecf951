// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/csv.h"

#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

namespace halocline::testing {
namespace {

std::vector<std::string> split_cells(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else if (c != '\r') {
      cells.back().push_back(c);
    }
  }
  return cells;
}

bool parse_number(const std::string& text, double& value) {
  std::istringstream stream(text);
  return static_cast<bool>(stream >> value) && stream.eof();
}

}  // namespace

const std::string& CsvRow::text(const std::string& column) const {
  const auto cell = cells_.find(column);
  if (cell == cells_.end()) throw std::runtime_error("no column " + column);
  return cell->second;
}

double CsvRow::number(const std::string& column) const {
  double value = 0;
  if (!parse_number(text(column), value)) {
    throw std::runtime_error("line " + std::to_string(line_) + ", " + column + ": '" + text(column) +
                             "' is no number");
  }
  return value;
}

bool CsvRow::has_number(const std::string& column) const {
  double value = 0;
  return parse_number(text(column), value);
}

std::vector<CsvRow> read_reference_csv(const std::string& path) {
  const std::string full_path = std::string(HALOCLINE_TEST_DATA) + "/" + path;
  std::ifstream file(full_path);
  std::string line;
  if (!std::getline(file, line)) throw std::runtime_error("cannot read " + full_path);
  const std::vector<std::string> columns = split_cells(line);
  std::vector<CsvRow> rows;
  for (int number = 2; std::getline(file, line); ++number) {
    if (line.empty()) continue;
    const std::vector<std::string> cells = split_cells(line);
    if (cells.size() != columns.size()) {
      throw std::runtime_error(full_path + ":" + std::to_string(number) + ": wrong number of cells");
    }
    std::map<std::string, std::string> by_name;
    for (std::size_t i = 0; i < cells.size(); ++i) by_name[columns[i]] = cells[i];
    rows.emplace_back(std::move(by_name), number);
  }
  if (rows.empty()) throw std::runtime_error(full_path + ": no rows");
  return rows;
}

}  // namespace halocline::testing
