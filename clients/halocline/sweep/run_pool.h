// Runs programs, several at a time, each a process with its output in a file.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace halocline::clients {

struct ProgramRun {
  std::vector<std::string> command;  // command[0] is a path
  std::string output_path;           // of both streams; replaced
};

struct ProgramEnd {
  int exit_code = 0;  // 128 + the signal that ended it, or 127 when it could not be started
  bool stopped = false;
};

// Runs one program to its end. When `should_stop` says so it gets SIGTERM, after ten seconds SIGKILL, and
// `stopped` is true.
ProgramEnd run_program(const ProgramRun& run, const std::function<bool()>& should_stop);

// Calls work(0) to work(count - 1), `jobs` at a time, each on one of `jobs` threads; none is begun once
// `should_stop` says so. The first exception ends the rest in the same way, and is thrown.
void for_each_parallel(std::size_t count, std::size_t jobs, const std::function<void(std::size_t)>& work,
                       const std::function<bool()>& should_stop);

}  // namespace halocline::clients
