// SPDX-License-Identifier: BSD-3-Clause
// A small web client on plain sockets, for tests: HTTP requests and WebSocket frames as bytes, also wrong
// ones.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/process.h"

namespace halocline::testing {

class WebClient {
 public:
  // Connects to 127.0.0.1; throws std::runtime_error when nobody listens.
  explicit WebClient(std::uint16_t port);
  ~WebClient();
  WebClient(const WebClient&) = delete;
  WebClient& operator=(const WebClient&) = delete;

  void send(const std::string& bytes) const;
  // What the server sent until it closed, or nothing more came for `limit`.
  std::string read_all() const;
  // Whether the server has closed the connection within `limit`.
  bool is_closed() const;

  // One request with these header lines (each with its end of line), and the whole answer.
  std::string request(const std::string& line, const std::string& headers) const;
  // Opens the WebSocket: the answer's first line.
  std::string open(const std::string& target, const std::string& headers);

  struct Message {
    bool binary = false;
    std::string bytes;
  };
  void send_message(const std::string& bytes, bool binary = false) const;
  // The next message; empty when none came within `limit`, or the connection ended.
  std::optional<Message> next(std::chrono::milliseconds limit = kHangLimit);

 private:
  bool fill(std::size_t bytes, std::chrono::steady_clock::time_point end);

  int socket_ = -1;
  std::string received_;
};

// A host header of the server.
std::string host_of(std::uint16_t port);
// A frame of a client: masked, final.
std::string frame(const std::string& bytes, int opcode);

}  // namespace halocline::testing
