// SPDX-License-Identifier: BSD-3-Clause
#include "core/names.h"

#include <algorithm>
#include <cstddef>

namespace halocline {

bool is_valid_name(std::string_view name) {
  constexpr std::size_t kMaxLength = 24;
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !name.empty() && name.size() <= kMaxLength && std::all_of(name.begin(), name.end(), allowed);
}

bool is_one_line(std::string_view text) {
  unsigned char before = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_eight_bits = before == 0xc2 && byte >= 0x80 && byte < 0xa0;
    if (byte < ' ' || byte == 0x7f || is_eight_bits) return false;
    before = byte;
  }
  return true;
}

std::string printable(std::string_view text) {
  std::string shown(text);
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return shown;
}

}  // namespace halocline
