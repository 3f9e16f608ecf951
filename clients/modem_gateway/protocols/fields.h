// SPDX-License-Identifier: BSD-3-Clause
// Fields of text protocols: words, lists, numbers, hexadecimal bytes. Nothing depends on a locale.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace halocline::modem_gateway {

// What stands between blanks.
std::vector<std::string_view> words_of(std::string_view text);
// What stands between separators, empty fields included: one more than there are separators.
std::vector<std::string_view> fields_of(std::string_view text, char separator);

// A decimal number that is all of the text and lies within the bounds; a sign + is allowed. None for anything
// else.
std::optional<std::int64_t> integer_in(std::string_view text, std::int64_t lowest, std::int64_t highest);
std::optional<double> number_in(std::string_view text, double lowest, double highest);

// Two upper-case digits a byte.
std::string hex_of(std::span<const std::uint8_t> bytes);
// Digits of either case, two a byte. None for anything else.
std::optional<std::vector<std::uint8_t>> bytes_of_hex(std::string_view hex);

// Bytes as text and back.
std::string_view as_text(std::span<const std::uint8_t> bytes);
std::vector<std::uint8_t> as_bytes(std::string_view text);

}  // namespace halocline::modem_gateway
