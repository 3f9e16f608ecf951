// SPDX-License-Identifier: BSD-3-Clause
// Whether what a program printed has reached its standard output.
#pragma once

namespace halocline::bus {

// Hands over what is buffered, of std::cout and of stdio. False when the system refused any of it (a full disk, a closed pipe): the
// program has then not done what was asked, and its exit code has to say so.
[[nodiscard]] bool output_is_whole();

}  // namespace halocline::bus
