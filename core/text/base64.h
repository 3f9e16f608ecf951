// SPDX-License-Identifier: BSD-3-Clause
// Base 64: bytes as text in the alphabet of RFC 4648, section 4.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace halocline {

std::string base64_of(std::span<const std::uint8_t> bytes);
// Returns nothing for a text that is not base 64.
std::optional<std::vector<std::uint8_t>> bytes_of_base64(std::string_view text);

}  // namespace halocline
