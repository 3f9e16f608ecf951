// SPDX-License-Identifier: BSD-3-Clause
// Names of vehicles, nodes and clients. They are suffixes of channels, so they are restricted to characters
// without a meaning in regular expressions and file systems. All other texts, in files and messages, are
// single lines.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace halocline {

inline constexpr std::int32_t kBroadcastId = 0;  // destination that means every vehicle

// True when `name` matches [a-z0-9_-]{1,24}.
[[nodiscard]] bool is_valid_name(std::string_view name);

// False if `text` contains control characters, including the 8-bit ones (C1) in UTF-8: line ends, and
// commands to a terminal.
[[nodiscard]] bool is_one_line(std::string_view text);

// Returns `text` with '?' in place of its control characters, except line ends.
[[nodiscard]] std::string without_controls(std::string_view text);

// Returns `text` in a form safe for a terminal: every character except visible ASCII and space becomes '?'.
[[nodiscard]] std::string printable(std::string_view text);

// Rule of is_valid_name() in words, for error messages.
inline constexpr std::string_view kNameRule = "1 to 24 characters of a-z, 0-9, '_' and '-'";
// Rule of is_one_line() in words, for error messages.
inline constexpr std::string_view kLineRule = "one line without control characters";

}  // namespace halocline
