// SPDX-License-Identifier: BSD-3-Clause
#include "tests/viewer/web_client.h"

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace halocline::testing {
namespace {

using Clock = std::chrono::steady_clock;

int milliseconds_to(Clock::time_point end) {
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
  return left > 0 ? static_cast<int>(left) : 0;
}

std::size_t big_endian(const std::string& bytes, std::size_t at, std::size_t count) {
  std::size_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = 256 * value + static_cast<unsigned char>(bytes[at + i]);
  return value;
}

}  // namespace

WebClient::WebClient(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): the interface of sockets
  if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    ::close(socket_);
    throw std::runtime_error("nobody listens on port " + std::to_string(port));
  }
}

WebClient::~WebClient() { ::close(socket_); }

void WebClient::send(const std::string& bytes) const {
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t count = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (count <= 0) return;  // the server has closed
    sent += static_cast<std::size_t>(count);
  }
}

std::string WebClient::read_all() const {
  constexpr std::chrono::milliseconds kLimit = kHangLimit;
  std::string all;
  std::array<char, 65536> bytes;
  for (pollfd ready{socket_, POLLIN, 0}; ::poll(&ready, 1, static_cast<int>(kLimit.count())) > 0;) {
    const ssize_t count = ::recv(socket_, bytes.data(), bytes.size(), 0);
    if (count <= 0) break;
    all.append(bytes.data(), static_cast<std::size_t>(count));
  }
  return all;
}

bool WebClient::is_closed() const {
  const auto end = Clock::now() + kHangLimit;
  std::array<char, 65536> bytes;
  for (pollfd ready{socket_, POLLIN, 0}; ::poll(&ready, 1, milliseconds_to(end)) > 0;) {
    if (::recv(socket_, bytes.data(), bytes.size(), 0) <= 0) return true;
  }
  return false;
}

std::string WebClient::request(const std::string& line, const std::string& headers) const {
  send(line + " HTTP/1.1\r\n" + headers + "Connection: close\r\n\r\n");
  return read_all();
}

std::string WebClient::open(const std::string& target, const std::string& headers) {
  send("GET " + target + " HTTP/1.1\r\n" + headers +
       "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
       "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
  const auto end = Clock::now() + kHangLimit;
  while (received_.find("\r\n\r\n") == std::string::npos && fill(received_.size() + 1, end)) {
  }
  const std::string first = received_.substr(0, received_.find("\r\n"));
  const std::size_t body = received_.find("\r\n\r\n");
  received_.erase(0, body == std::string::npos ? received_.size() : body + 4);
  return first;
}

void WebClient::send_message(const std::string& bytes, bool binary) const {
  send(frame(bytes, binary ? 2 : 1));
}

std::optional<WebClient::Message> WebClient::next(std::chrono::milliseconds limit) {
  const auto end = Clock::now() + limit;
  Message message;
  while (fill(2, end)) {
    const int first = static_cast<unsigned char>(received_[0]), opcode = first & 0x0F;
    std::size_t header = 2, size = static_cast<unsigned char>(received_[1]);
    if (size >= 126) {
      const std::size_t wide = size == 126 ? 2 : 8;
      if (!fill(2 + wide, end)) return std::nullopt;
      size = big_endian(received_, 2, wide);
      header += wide;
    }
    if (!fill(header + size, end)) return std::nullopt;
    const std::string payload = received_.substr(header, size);
    received_.erase(0, header + size);
    if (opcode == 8) return std::nullopt;
    if (opcode == 9) send(frame(payload, 10));
    if (opcode > 8) continue;
    if (opcode != 0) message.binary = opcode == 2;
    message.bytes += payload;
    if ((first & 0x80) != 0) return message;
  }
  return std::nullopt;
}

bool WebClient::fill(std::size_t bytes, Clock::time_point end) {
  std::array<char, 65536> buffer;
  while (received_.size() < bytes) {
    pollfd ready{socket_, POLLIN, 0};
    if (::poll(&ready, 1, milliseconds_to(end)) <= 0) return false;
    const ssize_t count = ::recv(socket_, buffer.data(), buffer.size(), 0);
    if (count <= 0) return false;
    received_.append(buffer.data(), static_cast<std::size_t>(count));
  }
  return true;
}

std::string host_of(std::uint16_t port) { return "Host: 127.0.0.1:" + std::to_string(port) + "\r\n"; }

std::string frame(const std::string& bytes, int opcode) {
  std::string out(1, static_cast<char>(0x80 | opcode));
  const std::size_t wide = bytes.size() < 126 ? 0 : bytes.size() < 65536 ? 2 : 8;
  out += static_cast<char>(0x80 | (wide == 0 ? static_cast<int>(bytes.size()) : wide == 2 ? 126 : 127));
  for (std::size_t i = wide; i-- > 0;) out += static_cast<char>(bytes.size() >> (8 * i));
  const std::string mask = "\x11\x22\x33\x44";
  out += mask;
  for (std::size_t i = 0; i < bytes.size(); ++i) out += static_cast<char>(bytes[i] ^ mask[i % 4]);
  return out;
}

}  // namespace halocline::testing
