#include "clients/halocline/sweep/run_pool.h"

#include <atomic>
#include <chrono>
#include <csignal>
#include <exception>
#include <mutex>
#include <thread>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace halocline::clients {
namespace {

constexpr std::chrono::milliseconds kLook{20};
constexpr std::chrono::seconds kPatience{10};
constexpr int kNotStarted = 127, kBySignal = 128;

pid_t start(const ProgramRun& run) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, run.output_path.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  std::vector<std::string> words = run.command;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = -1;
  const int error = posix_spawn(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  return error == 0 ? child : -1;
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
    } else if (end.stopped && now - stopped_at > kPatience) {
      kill(child, SIGKILL);
    }
    std::this_thread::sleep_for(kLook);
  }
}

void for_each_parallel(std::size_t count, std::size_t jobs, const std::function<void(std::size_t)>& work,
                       const std::function<bool()>& should_stop) {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto loop = [&] {
    for (std::size_t i = next++; i < count && !should_stop(); i = next++) {
      try {
        work(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
        next = count;
      }
    }
  };
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < std::min(jobs, count); ++i) threads.emplace_back(loop);
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace halocline::clients
