// Names of vehicles, nodes and clients: the suffixes of channels, so kept to characters that mean nothing to
// a regular expression or a file system.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace halocline {

inline constexpr std::int32_t kBroadcastId = 0;  // as a destination: every vehicle

// True when `name` matches [a-z0-9_-]{1,24}.
[[nodiscard]] bool is_valid_name(std::string_view name);

// `text` as a terminal may show it: what is not a visible character of ASCII or a space becomes '?'.
[[nodiscard]] std::string printable(std::string_view text);

// What is_valid_name accepts, in words for error messages.
inline constexpr std::string_view kNameRule = "1 to 24 characters of a-z, 0-9, '_' and '-'";

}  // namespace halocline
