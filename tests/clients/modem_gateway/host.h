// SPDX-License-Identifier: BSD-3-Clause
// A host's side of a modem interface: a TCP connection on loopback, or a file, that never waits longer than a
// few seconds.
#pragma once

#include <array>
#include <cerrno>
#include <chrono>
#include <functional>
#include <string>
#include <string_view>

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "clients/modem_gateway/endpoint.h"
#include "clients/modem_gateway/gateway_config.h"
#include "tests/support/process.h"

namespace halocline::modem_gateway::testing {

class Host {
 public:
  // To "tcp:PORT" or "pty:PATH".
  explicit Host(const std::string& place_text) {
    const Endpoint place = place_of(place_text);
    if (!place.is_tcp) {
      file_ = FileDescriptor(open(place.path.c_str(), O_RDWR | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
      return;
    }
    file_ = FileDescriptor(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(place.port);
    inet_pton(AF_INET, place.host.c_str(), &address.sin_addr);
    is_open_ = connect(file_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
    fcntl(file_.get(), F_SETFL, O_NONBLOCK);
    const int yes = 1;  // simulation time may pass while a system waits for more to send
    setsockopt(file_.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  }

  bool is_open() const { return is_open_; }
  // As much as the other side takes at once.
  void write(std::string_view bytes) const {
    if (send(file_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL) >= 0 || errno != ENOTSOCK) return;
    [[maybe_unused]] const auto written = ::write(file_.get(), bytes.data(), bytes.size());  // a serial line
  }
  // What there is by now.
  std::string read() {
    std::array<char, 65536> bytes{};
    const ssize_t size = ::read(file_.get(), bytes.data(), bytes.size());
    if (size == 0) is_open_ = false;
    return size > 0 ? std::string(bytes.data(), static_cast<std::size_t>(size)) : "";
  }
  void close() { file_ = FileDescriptor(); }

 private:
  FileDescriptor file_;
  bool is_open_ = true;
};

// Calls `work` until `done`; false when nothing makes it so.
inline bool work_until(const std::function<void()>& work, const std::function<bool()>& done) {
  const auto end = std::chrono::steady_clock::now() + halocline::testing::kHangLimit;
  while (!done()) {
    if (std::chrono::steady_clock::now() > end) return false;
    work();
  }
  return true;
}

}  // namespace halocline::modem_gateway::testing
