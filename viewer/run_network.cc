// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/run_network.h"

#include <cerrno>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "core/check.h"

namespace halocline::monitor {
namespace {

// Moves this process to a namespace of another one. Returns true on success; else errno says why.
bool enter(int pid, const char* space, int kind) {
  const int file = open(("/proc/" + std::to_string(pid) + "/ns/" + space).c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  const bool is_entered = setns(file, kind) == 0;
  const int reason = errno;
  close(file);
  errno = reason;
  return is_entered;
}

}  // namespace

RunNetwork::RunNetwork(int pid) {
  if (pid == 0) return;
  process_ = static_cast<int>(syscall(SYS_pidfd_open, pid, 0));
  require(process_ >= 0, "--network is " + std::to_string(pid) + ": there is no such process");
  // The network of a run without root belongs to a user namespace, which must be entered first.
  const bool is_entered = enter(pid, "net", CLONE_NEWNET) ||
                          (enter(pid, "user", CLONE_NEWUSER) && enter(pid, "net", CLONE_NEWNET));
  require(is_entered, "cannot enter the network of process " + std::to_string(pid) + ": " +
                          std::strerror(errno) + "; its user can, and root");
}

RunNetwork::~RunNetwork() {
  if (process_ >= 0) close(process_);
}

bool RunNetwork::has_ended() const {
  pollfd process{process_, POLLIN, 0};  // a negative descriptor is ignored
  return poll(&process, 1, 0) > 0;
}

}  // namespace halocline::monitor
