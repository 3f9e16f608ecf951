// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/guarded_reading.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>
#include <system_error>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/check.h"
#include "core/memory/memory_budget.h"

namespace halocline {
namespace {

// Exit codes of the child; sanitizers use others.
constexpr int kRead = 0, kOutOfMemory = 3;
// Limits on processor time. A megabyte that deflate has made of a gigabyte takes the most.
constexpr double kSeconds = 5, kSecondsAMegabyte = 5;

double megabytes_of(const std::vector<std::string>& paths) {
  double bytes = 0;
  for (const std::string& path : paths) {
    std::error_code error;
    const auto size = std::filesystem::file_size(path, error);
    if (!error) bytes += static_cast<double>(size);
  }
  return bytes / 1e6;
}

void limit(decltype(RLIMIT_AS) resource, double most) {
  rlimit bounds{};
  if (!std::isfinite(most) || getrlimit(resource, &bounds) != 0) return;
  bounds.rlim_cur = std::min(bounds.rlim_max, static_cast<rlim_t>(most));
  setrlimit(resource, &bounds);
}

// A crash ends the child by its signal, without messages.
void become_expendable(double seconds, double address_space) {
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGSYS, SIGXCPU})
    std::signal(signal, SIG_DFL);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, std::ceil(seconds));
  limit(RLIMIT_AS, address_space);
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
}

// Ends the child immediately: no exit handlers, no destructors, no flush of buffers that the parent still has
// to write.
[[noreturn]] void read_and_end(const std::function<void()>& reading) {
  try {
    reading();
  } catch (const std::bad_alloc&) {
    _exit(kOutOfMemory);
  } catch (...) {
  }
  _exit(kRead);
}

// While in scope, the system keeps the exit status of a child, even if this process was started with SIGCHLD
// ignored.
class KeptEnds {
 public:
  KeptEnds() {
    struct sigaction keep {};
    keep.sa_handler = SIG_DFL;
    sigaction(SIGCHLD, &keep, &before_);
  }
  ~KeptEnds() { sigaction(SIGCHLD, &before_, nullptr); }
  KeptEnds(const KeptEnds&) = delete;
  KeptEnds& operator=(const KeptEnds&) = delete;

 private:
  struct sigaction before_ {};
};

int status_of(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    ensure(errno == EINTR, "the child that reads a file first is waited for here alone");
  return status;
}

std::string end_in_words(int status) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == kOutOfMemory)
    return ": reading it takes more memory than is available";
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
    return " is damaged: the library that reads it does not come to an end";
  const std::string signal =
      WIFSIGNALED(status) ? std::string(" (") + strsignal(WTERMSIG(status)) + ")" : std::string();
  return " is damaged: the library that reads it crashes on it" + signal;
}

}  // namespace

void require_survivable(const std::vector<std::string>& paths, const std::function<void()>& reading) {
  const double seconds = kSeconds + kSecondsAMegabyte * megabytes_of(paths);
  const double address_space = mapped_memory_bytes() + available_memory_bytes();
  const KeptEnds kept;
  const pid_t child = fork();
  if (child == 0) {
    become_expendable(seconds, address_space);
    read_and_end(reading);
  }
  std::string names;
  for (const std::string& path : paths) names += (names.empty() ? "" : " or ") + path;
  require(child > 0, names + ": no process can be made to read it first: " + std::strerror(errno));
  const int status = status_of(child);
  if (status != kRead) throw InvalidArgument(names + end_in_words(status));
}

bool is_hdf5(const std::string& path) {
  constexpr char kSignature[] = {'\x89', 'H', 'D', 'F', '\r', '\n', '\x1a', '\n'};
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  std::ifstream file(path, std::ios::binary);
  for (std::streamoff at = 0; file.good(); at = std::max<std::streamoff>(512, 2 * at)) {
    char start[sizeof kSignature] = {};
    file.seekg(at).read(start, sizeof start);
    if (file && std::memcmp(start, kSignature, sizeof start) == 0) return true;
  }
  return false;
}

}  // namespace halocline
