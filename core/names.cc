// SPDX-License-Identifier: BSD-3-Clause
#include "core/names.h"

#include <algorithm>
#include <cstddef>

namespace halocline {
namespace {

// True if `c` is a control character or, after the byte `before`, the second byte of an 8-bit control
// character.
bool is_control(unsigned char before, char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte < ' ' || byte == 0x7f || (before == 0xc2 && byte >= 0x80 && byte < 0xa0);
}

}  // namespace

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
    if (is_control(before, c)) return false;
    before = static_cast<unsigned char>(c);
  }
  return true;
}

std::string without_controls(std::string_view text) {
  std::string shown(text);
  unsigned char before = 0;
  for (char& c : shown) {
    const bool stays = c == '\n' || !is_control(before, c);
    before = static_cast<unsigned char>(c);
    if (!stays) c = '?';
  }
  return shown;
}

std::string printable(std::string_view text) {
  std::string shown(text);
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return shown;
}

}  // namespace halocline
