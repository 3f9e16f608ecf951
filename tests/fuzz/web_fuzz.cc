// SPDX-License-Identifier: BSD-3-Clause
// The monitor's web server on a socket of this host: HTTP as it is, or a WebSocket's frames behind a sound
// request for one, in pieces.
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/check.h"
#include "tests/fuzz/fuzz_input.h"
#include "viewer/web/web_server.h"

namespace {

using namespace halocline;
using namespace halocline::monitor;

constexpr std::string_view kUpgrade =
    "GET /ws HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n"
    "Sec-WebSocket-Protocol: halocline.monitor.v1\r\n\r\n";

// Answers each message of a page with the same.
struct Server {
  Server()
      : web(open_web_server({.access = {.token = ""}, .page = "/nowhere"},
                            {.opened = [](ConnectionId, WebProtocol) {},
                             .received =
                                 [this](ConnectionId id, std::string_view message, bool binary) {
                                   ensure(message.size() <= WebServer::kMaxMessageBytes,
                                          "a message is within its bound");
                                   web->send(id, std::make_shared<const std::string>(message), binary);
                                   return true;
                                 },
                             .closed = [](ConnectionId) {}})) {
    const std::string url = web->url();  // http://127.0.0.1:PORT/
    port = static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1)));
  }
  void serve() {
    web->run_for(std::chrono::milliseconds(1));
    web->resume();
  }

  std::unique_ptr<WebServer> web;
  std::uint16_t port = 0;
};

class Client {
 public:
  explicit Client(std::uint16_t port) : file_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    ensure(connect(file_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0, "the server listens");
    const linger at_once{1, 0};  // no port waits for the connection's end
    setsockopt(file_, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
  }
  ~Client() { close(file_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void write(std::string_view bytes) const {
    [[maybe_unused]] const auto sent = send(file_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  }
  void read() const {
    std::vector<char> bytes(1u << 16);
    while (recv(file_, bytes.data(), bytes.size(), MSG_DONTWAIT) > 0) {
    }
  }

 private:
  int file_;
};

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Server server;
  fuzz::Input input(data, size);
  {
    const Client client(server.port);
    server.serve();
    if (input.below(2) == 1) {
      std::string upgrade(kUpgrade);
      upgrade.insert(upgrade.find("127.0.0.1") + 9, ":" + std::to_string(server.port));
      client.write(upgrade);
      server.serve();
    }
    while (!input.is_empty()) {
      client.write(input.text_block());
      server.serve();
      client.read();
    }
  }
  server.serve();
  ensure(server.web->queued_bytes() <= 16 * WebServer::kMaxQueuedBytes, "what waits is within its bound");
  return 0;
}
