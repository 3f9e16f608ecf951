// SPDX-License-Identifier: BSD-3-Clause
// Comma-separated tables, read by profiles and the quantity calculator.
//
// Format: RFC 4180 (quoted cells may contain commas and doubled quotes, but no line breaks). The first line
// that is neither empty nor a comment names the columns. Lines that start with '#' and empty lines are
// skipped. Spaces around a cell, and a byte order mark at the start, are ignored. A row keeps its text, so it
// can be written back unchanged. The functions work on streams; the caller opens files. Conversion of
// numbers, in cells and elsewhere, does not depend on the locale.
#pragma once

#include <charconv>
#include <iosfwd>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace halocline {

struct CsvLine {
  int number;                      // in the stream, from 1
  std::string text;                // unchanged, without the line's end
  std::vector<std::string> cells;  // without quotes and surrounding spaces; as many as there are columns
};

struct CsvTable {
  CsvLine header;
  std::vector<CsvLine> rows;

  // Returns the index of the column of exactly this name; nothing if there is none.
  std::optional<std::size_t> column(std::string_view name) const;
};

// Reads a table. Errors (no header, a column named twice, rows with too few or too many cells, an unclosed
// quote) are appended to `errors`, one line of text each, and faulty rows are left out.
CsvTable read_csv(std::istream& in, std::vector<std::string>& errors);

// Returns the text as one cell, quoted if it contains characters that would end the cell or the line.
std::string csv_cell(std::string_view text);

// Returns the number, within [lowest, highest], that the whole of `text` states. Returns nothing for an empty
// text, spaces, a unit, hexadecimal, NaN, and, with the default bounds, an infinity. A sign + is permitted. A
// real number may have an exponent, and is rounded to the nearest double.
template <class Number = double>
[[nodiscard]] std::optional<Number> parse_number(std::string_view text,
                                                 Number lowest = std::numeric_limits<Number>::lowest(),
                                                 Number highest = std::numeric_limits<Number>::max()) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_whole = error == std::errc() && end == text.data() + text.size();
  return is_whole && value >= lowest && value <= highest ? std::optional(value) : std::nullopt;
}

// Returns the shortest text that reads back as the same double (up to 17 digits).
std::string format_number(double value);

}  // namespace halocline
