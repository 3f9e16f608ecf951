// SPDX-License-Identifier: BSD-3-Clause
// Texts in UTF-8.
#pragma once

#include <cstddef>
#include <string>

namespace halocline {

// At most so many bytes of a text, without a broken character at the end.
[[nodiscard]] std::string beginning_of(const std::string& text, std::size_t bytes);

}  // namespace halocline
