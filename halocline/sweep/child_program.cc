// SPDX-License-Identifier: BSD-3-Clause
#include "halocline/sweep/child_program.h"

#include <chrono>
#include <csignal>
#include <thread>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace halocline::clients {
namespace {

constexpr std::chrono::milliseconds kPollInterval{20};
constexpr std::chrono::seconds kStopTimeout{10};
constexpr int kNotStarted = 127, kBySignal = 128;

// Runs in the child between fork and exec: async-signal-safe calls only. The kernel sends SIGKILL to the
// child when the thread that forked ends, for any reason; a parent that ended before this was requested is
// recognised by the parent id.
[[noreturn]] void become(char* const* arguments, const char* output_path, pid_t parent) {
  const int in = open("/dev/null", O_RDONLY);
  const int out = open(output_path, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  const bool bound_to_parent = prctl(PR_SET_PDEATHSIG, SIGKILL) == 0 && getppid() == parent;
  if (bound_to_parent && dup2(in, STDIN_FILENO) >= 0 && dup2(out, STDOUT_FILENO) >= 0 &&
      dup2(out, STDERR_FILENO) >= 0)
    execv(arguments[0], arguments);
  _exit(kNotStarted);
}

pid_t start(const ProgramRun& run) {
  std::vector<std::string> words = run.command;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t parent = getpid(), child = fork();
  if (child == 0) become(arguments.data(), run.output_path.c_str(), parent);
  return child;
}

}  // namespace

ProgramEnd run_program(const ProgramRun& run, const std::function<bool()>& should_stop) {
  const pid_t child = start(run);
  if (child < 0) return {kNotStarted, false};
  ProgramEnd end;
  std::chrono::steady_clock::time_point stopped_at;
  for (int status = 0;;) {
    if (waitpid(child, &status, WNOHANG) == child) {
      end.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : kBySignal + WTERMSIG(status);
      return end;
    }
    const auto now = std::chrono::steady_clock::now();
    if (!end.stopped && should_stop()) {
      end.stopped = true;
      stopped_at = now;
      kill(child, SIGTERM);
    } else if (end.stopped && now - stopped_at > kStopTimeout) {
      kill(child, SIGKILL);
    }
    std::this_thread::sleep_for(kPollInterval);
  }
}

}  // namespace halocline::clients
