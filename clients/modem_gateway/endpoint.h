// SPDX-License-Identifier: BSD-3-Clause
// Files by which hosts reach a door: a listening TCP socket, or a pseudo-terminal with a symbolic link to it. All non-blocking.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "clients/modem_gateway/gateway_config.h"

namespace halocline::modem_gateway {

// Owns a file descriptor; -1: none.
class File {
 public:
  File() = default;
  explicit File(int fd) : fd_(fd) {}
  File(File&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  File& operator=(File&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File();

  int get() const { return fd_; }

 private:
  int fd_ = -1;
};

// A socket that listens at `place`. Throws InvalidArgument where the port is taken.
File listen_tcp(const Place& place);
// The port that it has; of interest where the place names 0.
std::uint16_t port_of(const File& listening);
// The next connection that waits; none (-1) when none does.
File accept_connection(const File& listening);

// Our side of a pseudo-terminal; hosts open the other as a serial port, raw, by the link at `path`, which is replaced if it is
// a link already. Throws InvalidArgument where the link cannot be made.
File open_pty(const std::string& path);
// Whether a host has the other side open.
bool is_pty_open(const File& pty);

}  // namespace halocline::modem_gateway
