// SPDX-License-Identifier: BSD-3-Clause
// Bytes as text of the alphabet of RFC 4648, section 4.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace halocline {

std::string base64_of(std::span<const std::uint8_t> bytes);
// None for a text that is no base 64.
std::optional<std::vector<std::uint8_t>> bytes_of_base64(std::string_view text);

}  // namespace halocline
