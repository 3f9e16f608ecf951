// SPDX-License-Identifier: BSD-3-Clause
// Names of vehicles, nodes and clients: the suffixes of channels, so kept to characters that mean nothing to
// a regular expression or a file system. All other texts, of files and of messages, are one line each.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace halocline {

inline constexpr std::int32_t kBroadcastId = 0;  // as a destination: every vehicle

// True when `name` matches [a-z0-9_-]{1,24}.
[[nodiscard]] bool is_valid_name(std::string_view name);

// False where `text` holds control characters, those of eight bits in UTF-8 among them: line ends, and what
// commands a terminal.
[[nodiscard]] bool is_one_line(std::string_view text);

// `text` with '?' in the place of its control characters, but for line ends.
[[nodiscard]] std::string without_controls(std::string_view text);

// `text` as a terminal may show it: what is not a visible character of ASCII or a space becomes '?'.
[[nodiscard]] std::string printable(std::string_view text);

// What is_valid_name accepts, in words for error messages.
inline constexpr std::string_view kNameRule = "1 to 24 characters of a-z, 0-9, '_' and '-'";
// Likewise is_one_line.
inline constexpr std::string_view kLineRule = "one line without control characters";

}  // namespace halocline
