// SPDX-License-Identifier: BSD-3-Clause
// Notation of a 64-bit number by 16 hexadecimal digits, for hashes, versions and sessions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace halocline {

[[nodiscard]] inline std::string hex_digits(std::uint64_t number) {
  std::string text(16, '0');
  for (std::size_t i = text.size(); i-- > 0; number >>= 4) text[i] = "0123456789abcdef"[number & 15];
  return text;
}

}  // namespace halocline
