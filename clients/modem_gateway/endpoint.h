// SPDX-License-Identifier: BSD-3-Clause
// Files by which hosts reach a door: a listening TCP socket, or a pseudo-terminal with a symbolic link to it.
// All non-blocking.
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

// Owns a symbolic link: removes it at the end, where it still points to the target that it was made with.
class Link {
 public:
  Link() = default;
  // Replaces a symbolic link and nothing else. Throws InvalidArgument where the link cannot be made.
  Link(std::string path, std::string target);
  Link(Link&& other) noexcept
      : path_(std::exchange(other.path_, "")), target_(std::exchange(other.target_, "")) {}
  Link& operator=(Link&& other) noexcept {
    std::swap(path_, other.path_);
    std::swap(target_, other.target_);
    return *this;
  }
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;
  ~Link();

 private:
  std::string path_, target_;  // empty: none
};

// Our side of a pseudo-terminal; hosts open the other side as a serial port by the link, raw from the
// beginning.
struct SerialLine {
  File terminal;
  Link link;
};
// Makes the link at `path`. Throws InvalidArgument where that is impossible.
SerialLine open_pty(const std::string& path);
// Whether a host has the other side open.
bool is_pty_open(const File& pty);

}  // namespace halocline::modem_gateway
