// SPDX-License-Identifier: BSD-3-Clause
// Operations on UTF-8 text.
#pragma once

#include <cstddef>
#include <string>

namespace halocline {

// Returns at most the first `bytes` bytes of a text, without an incomplete character at the end.
[[nodiscard]] std::string beginning_of(const std::string& text, std::size_t bytes);

}  // namespace halocline
