// SPDX-License-Identifier: BSD-3-Clause
// Parsing of text protocols: words, lists, numbers and hexadecimal bytes, independent of the locale.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace halocline::modem_gateway {

// Splits at blanks and drops empty words.
std::vector<std::string_view> words_of(std::string_view text);
// Splits at each separator and keeps empty fields: the result has one field more than there are separators.
std::vector<std::string_view> fields_of(std::string_view text, char separator);

// Parses a decimal number that makes up the whole text and lies within the bounds; a leading + is allowed.
// Returns nothing for any other text.
std::optional<std::int64_t> integer_in(std::string_view text, std::int64_t lowest, std::int64_t highest);
std::optional<double> number_in(std::string_view text, double lowest, double highest);

// Returns two upper-case digits a byte.
std::string hex_of(std::span<const std::uint8_t> bytes);
// Parses two digits a byte, of either case. Returns nothing for any other text.
std::optional<std::vector<std::uint8_t>> bytes_of_hex(std::string_view hex);

// Reinterprets bytes as text, and the reverse.
std::string_view as_text(std::span<const std::uint8_t> bytes);
std::vector<std::uint8_t> as_bytes(std::string_view text);

}  // namespace halocline::modem_gateway
