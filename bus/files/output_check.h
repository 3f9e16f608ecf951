// SPDX-License-Identifier: BSD-3-Clause
// What a program says at its end: whether what it printed has reached its standard output, and why it failed.
#pragma once

#include <string_view>

namespace halocline::bus {

// Hands over what is buffered, of std::cout and of stdio. False when the system refused any of it (a full
// disk, a closed pipe): the program has then not done what was asked, and its exit code has to say so.
[[nodiscard]] bool output_is_whole();

// "program: reason" on standard error. A reason may hold names of files and arguments as they were given:
// nothing in it moves a terminal's cursor.
void print_failure(std::string_view program, std::string_view reason);

}  // namespace halocline::bus
