// SPDX-License-Identifier: BSD-3-Clause
#include "core/csv_table.h"

#include <cmath>
#include <istream>
#include <set>

namespace halocline {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(" \t") - first + 1));
}

// Returns nothing when a quote is left open.
std::optional<std::vector<std::string>> split_cells(std::string_view text) {
  std::vector<std::string> cells;
  std::string cell;
  bool quoted = false, was_quoted = false;
  const auto finish = [&] {
    cells.push_back(was_quoted ? cell : trimmed(cell));
    cell.clear();
    was_quoted = false;
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '"' && i + 1 < text.size() && text[i + 1] == '"') {
      cell.push_back('"');
      ++i;
    } else if (c == '"' && (quoted || trimmed(cell).empty())) {
      if (!quoted) cell.clear();
      quoted = !quoted;
      was_quoted = true;
    } else if (c == ',' && !quoted) {
      finish();
    } else if (quoted || !was_quoted || (c != ' ' && c != '\t')) {
      cell.push_back(c);
    }
  }
  if (quoted) return std::nullopt;
  finish();
  return cells;
}

bool is_skipped(std::string_view text) {
  const std::string cell = trimmed(text);
  return cell.empty() || cell.front() == '#';
}

std::string at_line(int number) { return "line " + std::to_string(number) + ": "; }

void check_column_names(const CsvLine& header, std::vector<std::string>& errors) {
  std::set<std::string> seen;
  for (const std::string& name : header.cells) {
    if (!seen.insert(name).second)
      errors.push_back(at_line(header.number) + "column '" + name + "' is named twice");
  }
}

}  // namespace

std::optional<std::size_t> CsvTable::column(std::string_view name) const {
  for (std::size_t i = 0; i < header.cells.size(); ++i) {
    if (header.cells[i] == name) return i;
  }
  return std::nullopt;
}

CsvTable read_csv(std::istream& in, std::vector<std::string>& errors) {
  CsvTable table;
  bool has_header = false;
  std::string text;
  for (int number = 1; std::getline(in, text); ++number) {
    if (!text.empty() && text.back() == '\r') text.pop_back();
    if (number == 1 && text.starts_with(kByteOrderMark)) text.erase(0, kByteOrderMark.size());
    if (is_skipped(text)) continue;
    const auto cells = split_cells(text);
    if (!cells) {
      errors.push_back(at_line(number) + "a quote is left open");
    } else if (!has_header) {
      table.header = {number, text, *cells};
      has_header = true;
      check_column_names(table.header, errors);
    } else if (cells->size() != table.header.cells.size()) {
      errors.push_back(at_line(number) + std::to_string(cells->size()) + " cells where the header names " +
                       std::to_string(table.header.cells.size()) + " columns");
    } else {
      table.rows.push_back({number, text, *cells});
    }
  }
  if (!has_header) errors.push_back("line 1: no header: the first line has to name the columns");
  return table;
}

std::string csv_cell(std::string_view text) {
  if (text.find_first_of(",\"\n\r") == std::string_view::npos) return std::string(text);
  std::string cell = "\"";
  for (const char c : text) cell += c == '"' ? std::string("\"\"") : std::string(1, c);
  return cell + "\"";
}

std::string format_number(double value) {
  char text[32];  // the longest double takes 24 characters
  const auto [end, error] = std::to_chars(text, text + sizeof(text), value);
  return std::string(text, error == std::errc() ? end : text);
}

}  // namespace halocline
