// SPDX-License-Identifier: BSD-3-Clause
// Child processes, for tests of whole programs.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include <sys/types.h>

namespace halocline::testing {

// Limit after which a test takes what it waits for as hung. It bounds no speed: a busy machine may need most
// of it.
constexpr std::chrono::seconds kHangLimit{300};

// A program running beside the test, its standard output and error kept. Ended by SIGKILL when it goes out of
// scope.
class Process {
 public:
  // `command[0]` is a path; the others are its arguments.
  explicit Process(const std::vector<std::string>& command);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  pid_t pid() const { return pid_; }
  void signal(int number) const;
  bool running();
  // Waits for the end: the exit code, 128 + the signal that ended it, or -1 when it still runs after `limit`.
  int wait(std::chrono::milliseconds limit = kHangLimit);
  // Processor time that it has used, s; in ticks of 10 ms while it runs.
  double processor_s();
  // What it has written so far, both streams in one.
  std::string output() const;

 private:
  pid_t pid_ = -1;
  int status_ = -1;
  double processor_s_ = 0;  // once it has ended
  std::string output_path_;
};

}  // namespace halocline::testing
