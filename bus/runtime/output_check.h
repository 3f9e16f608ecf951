// SPDX-License-Identifier: BSD-3-Clause
// Final messages of a program: checks that its output has reached standard output, and prints why it failed.
#pragma once

#include <string_view>

namespace halocline::bus {

// Flushes std::cout and stdio. Returns false when the system refused any output (a full disk, a closed pipe):
// the program has then not done its task, and its exit code must say so.
[[nodiscard]] bool output_is_whole();

// Prints "program: reason" on standard error. The reason may contain names of files and arguments; control
// characters in it are removed, so that it cannot control the terminal.
void print_failure(std::string_view program, std::string_view reason);

}  // namespace halocline::bus
