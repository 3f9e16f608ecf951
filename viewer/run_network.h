// SPDX-License-Identifier: BSD-3-Clause
// Network namespace of an isolated run (scripts/isolated): a process enters it and keeps its open sockets.
#pragma once

namespace halocline::monitor {

class RunNetwork {
 public:
  // Moves this process, which must have one thread yet, to the network of process `pid`; 0: it stays in its
  // own. The run of another user can be entered by root alone. Throws InvalidArgument, which says why, on
  // failure.
  explicit RunNetwork(int pid);
  ~RunNetwork();
  RunNetwork(const RunNetwork&) = delete;
  RunNetwork& operator=(const RunNetwork&) = delete;

  bool has_ended() const;

 private:
  int process_ = -1;  // pidfd of the process
};

}  // namespace halocline::monitor
