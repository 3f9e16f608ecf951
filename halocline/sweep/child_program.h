// SPDX-License-Identifier: BSD-3-Clause
// Runs a program as a child process, with its output in a file.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace halocline::clients {

struct ProgramRun {
  std::vector<std::string> command;  // command[0] is a path
  std::string output_path;           // receives stdout and stderr; replaced
};

struct ProgramEnd {
  int exit_code = 0;  // 128 + the signal that ended it, or 127 when it could not be started
  bool stopped = false;
};

// Runs a program to its end. When `should_stop` becomes true the program gets SIGTERM, and SIGKILL ten
// seconds later, and `stopped` is true. The program does not outlive the calling thread or process: the
// kernel then sends it SIGKILL.
ProgramEnd run_program(const ProgramRun& run, const std::function<bool()>& should_stop);

}  // namespace halocline::clients
