// SPDX-License-Identifier: BSD-3-Clause
// The network of a run that has one of its own (scripts/isolated): a process enters it, and keeps the sockets
// that it had.
#pragma once

namespace halocline::monitor {

class RunNetwork {
 public:
  // From now on this process, which has one thread yet, is in the network of process `pid`; 0: it stays where
  // it is. A run of another user can be entered by root alone. Throws InvalidArgument that says why it
  // cannot.
  explicit RunNetwork(int pid);
  ~RunNetwork();
  RunNetwork(const RunNetwork&) = delete;
  RunNetwork& operator=(const RunNetwork&) = delete;

  // Whether that process has ended.
  bool has_ended() const;

 private:
  int process_ = -1;  // a descriptor of it
};

}  // namespace halocline::monitor
