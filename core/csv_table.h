// SPDX-License-Identifier: BSD-3-Clause
// Comma-separated tables as text: what profiles and the quantity calculator read and write.
//
// Format: RFC 4180 (quoted cells may hold commas and doubled quotes, but no line breaks); the first line that
// is neither empty nor a comment names the columns; lines that start with '#' and empty lines are skipped;
// spaces around a cell and a byte order mark at the start do not count. A row keeps its text, so it can be
// written back unchanged. Works on streams: opening files is for the caller. Numbers, of cells and elsewhere,
// do not depend on the locale.
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
  std::string text;                // as it stood, without the line's end
  std::vector<std::string> cells;  // without quotes and surrounding spaces; as many as there are columns
};

struct CsvTable {
  CsvLine header;
  std::vector<CsvLine> rows;

  // Index of the column of that very name; empty when there is none.
  std::optional<std::size_t> column(std::string_view name) const;
};

// Appends what is wrong with the text (no header, a column named twice, rows with too few or too many cells,
// a quote left open) to `errors`, a line of text each, and leaves such rows out.
CsvTable read_csv(std::istream& in, std::vector<std::string>& errors);

// The text as one cell: in quotes when it holds what would end the cell or the line.
std::string csv_cell(std::string_view text);

// The number that the whole of `text` states, in [lowest, highest]; none otherwise: an empty text, spaces, a
// unit, hexadecimal, NaN, and without bounds an infinity. A sign + is allowed. A real number may have an
// exponent, and is the double nearest to the text.
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

// The shortest text that reads back as the same double (up to 17 digits).
std::string format_number(double value);

}  // namespace halocline
