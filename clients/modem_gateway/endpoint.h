// SPDX-License-Identifier: BSD-3-Clause
// Files by which hosts reach an emulated modem interface: a listening TCP socket, or a pseudo-terminal with a
// symbolic link to it. All are non-blocking.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "clients/modem_gateway/gateway_config.h"

namespace halocline::modem_gateway {

// Owner of a file descriptor; -1 means none.
class FileDescriptor {
 public:
  FileDescriptor() = default;
  explicit FileDescriptor(int fd) : fd_(fd) {}
  FileDescriptor(FileDescriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  ~FileDescriptor();

  int get() const { return fd_; }

 private:
  int fd_ = -1;
};

// Returns a socket that listens at `place`. Throws InvalidArgument when the port is taken.
FileDescriptor listen_tcp(const Endpoint& place);
// Returns the port on which the socket listens, of interest where the place names port 0.
std::uint16_t port_of(const FileDescriptor& listening);
// Accepts the next waiting connection; -1 when none waits.
FileDescriptor accept_connection(const FileDescriptor& listening);

// Owner of a symbolic link: the destructor removes it, provided that it still points to its original target.
class Link {
 public:
  Link() = default;
  // Makes the link; an existing symbolic link is replaced, any other file is not. Throws InvalidArgument when
  // the link cannot be made.
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
  std::string path_, target_;  // empty: no link
};

// The gateway's side of a pseudo-terminal. Hosts open the other side as a serial port through the link; it is
// in raw mode from the beginning.
struct SerialLine {
  FileDescriptor terminal;
  Link link;
};
// Makes a pseudo-terminal and a link to it at `path`. Throws InvalidArgument when that is impossible.
SerialLine open_pty(const std::string& path);
// Returns true when a host has the other side open.
bool is_pty_open(const FileDescriptor& pty);

}  // namespace halocline::modem_gateway
