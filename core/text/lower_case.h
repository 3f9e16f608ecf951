// SPDX-License-Identifier: BSD-3-Clause
// Conversion of ASCII letters to lower case, whatever the locale.
#pragma once

#include <string>
#include <string_view>

namespace halocline {

[[nodiscard]] inline std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

}  // namespace halocline
