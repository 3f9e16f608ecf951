// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/endpoint.h"

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <string_view>

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <pty.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include "core/check.h"

namespace halocline::modem_gateway {
namespace {

constexpr int kBacklog = 64;

sockaddr* as_sockaddr(sockaddr_in& address) { return reinterpret_cast<sockaddr*>(&address); }

void require_done(bool done, const std::string& what) { require(done, what + ": " + std::strerror(errno)); }

}  // namespace

FileDescriptor::~FileDescriptor() {
  if (fd_ >= 0) close(fd_);
}

FileDescriptor listen_tcp(const Endpoint& place) {
  FileDescriptor socket_file(socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const std::string what = "a modem interface cannot listen at " + place.text();
  require_done(socket_file.get() >= 0, what);
  const int yes = 1;
  setsockopt(socket_file.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(place.port);
  inet_pton(AF_INET, place.host.c_str(), &address.sin_addr);
  require_done(bind(socket_file.get(), as_sockaddr(address), sizeof address) == 0, what);
  require_done(listen(socket_file.get(), kBacklog) == 0, what);
  return socket_file;
}

std::uint16_t port_of(const FileDescriptor& listening) {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  getsockname(listening.get(), as_sockaddr(address), &size);
  return ntohs(address.sin_port);
}

FileDescriptor accept_connection(const FileDescriptor& listening) {
  FileDescriptor connection(accept4(listening.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  const int yes = 1;  // without Nagle's delay: answers are short, and a host waits for each
  if (connection.get() >= 0) setsockopt(connection.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  return connection;
}

Link::Link(std::string path, std::string target) : path_(std::move(path)), target_(std::move(target)) {
  struct stat there {};
  if (lstat(path_.c_str(), &there) == 0 && S_ISLNK(there.st_mode)) unlink(path_.c_str());
  require_done(symlink(target_.c_str(), path_.c_str()) == 0,
               "a modem interface cannot make the link " + path_);
}

Link::~Link() {
  if (path_.empty()) return;
  std::array<char, 128> target{};
  const ssize_t size = readlink(path_.c_str(), target.data(), target.size());
  if (size >= 0 && std::string_view(target.data(), static_cast<std::size_t>(size)) == target_)
    unlink(path_.c_str());
}

SerialLine open_pty(const std::string& path) {
  int ours = -1, theirs = -1;
  std::array<char, 128> name{};
  require_done(openpty(&ours, &theirs, name.data(), nullptr, nullptr) == 0, "no pseudo-terminal for " + path);
  FileDescriptor pty(ours);
  const FileDescriptor other(theirs);  // closed on return: the terminal stays while `ours` is open
  termios settings{};
  tcgetattr(theirs, &settings);
  cfmakeraw(&settings);
  tcsetattr(theirs, TCSANOW, &settings);
  fcntl(ours, F_SETFL, O_NONBLOCK);
  fcntl(ours, F_SETFD, FD_CLOEXEC);
  return {std::move(pty), Link(path, name.data())};
}

bool is_pty_open(const FileDescriptor& pty) {
  pollfd state{pty.get(), POLLIN, 0};
  return poll(&state, 1, 0) >= 0 && (state.revents & POLLHUP) == 0;
}

}  // namespace halocline::modem_gateway
