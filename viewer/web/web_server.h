// SPDX-License-Identifier: BSD-3-Clause
// HTTP and WebSocket server of the monitor's page: files of the bundle, and connections at /ws.
//
// It uses one thread: callbacks are called from run_for(), and all functions must be called from its thread.
// Nothing waits for a client: what is sent is queued. Bounds keep any client from taking more than its share:
//
// - at most kMaxTransports TCP connections and kMaxConnections WebSockets; more are refused (503);
// - headers of at most 16 kB, requests without a body, messages of at most kMaxMessageBytes; ten seconds for
//   a request;
// - a client that leaves kMaxQueuedBytes unread, or reads nothing for kMaxStall, is dropped, as is one that
//   does not answer pings for 20 s;
// - a client whose message was refused (WebHandlers::received), or that leaves much unread, is not read until
//   resume(): a flood of messages waits in its own socket.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "viewer/web/web_rules.h"

namespace halocline::monitor {

using ConnectionId = std::int64_t;
using SharedBytes = std::shared_ptr<const std::string>;

// Subprotocols halocline.monitor.v1 and foxglove.websocket.v1.
enum class WebProtocol { kMonitor, kFoxglove };

struct WebHandlers {
  std::function<void(ConnectionId, WebProtocol)> opened;
  // Returns false when the message cannot be handled now; resume() then offers it again.
  std::function<bool(ConnectionId, std::string_view message, bool binary)> received;
  std::function<void(ConnectionId)> closed;
};

class WebServer {
 public:
  static constexpr std::size_t kMaxTransports = 64, kMaxConnections = 16;
  static constexpr std::size_t kMaxMessageBytes = 64 * 1024;
  static constexpr std::size_t kMaxQueuedBytes = 16 * 1024 * 1024;
  static constexpr std::chrono::seconds kMaxStall{15};

  struct Options {
    WebAccess access = {};  // port 0: any free one
    std::string page = {};  // folder of the bundle
    int socket = -1;        // socket of listening_socket(), owned; -1: opens one
  };
  virtual ~WebServer() = default;

  // Returns the URL of the page, with the token.
  virtual std::string url() const = 0;

  virtual void run_for(std::chrono::milliseconds duration) = 0;
  // Offers refused messages again, and drops clients that have stalled.
  virtual void resume() = 0;

  virtual void close(ConnectionId id) = 0;
  // Queues one message; ignored for a connection that has ended. Never calls back.
  virtual void send(ConnectionId id, SharedBytes message, bool binary) = 0;
  // Returns true when everything sent has been written to the network; false for a connection that has ended.
  virtual bool is_idle(ConnectionId id) const = 0;
  // Returns the bytes that are queued for all clients together.
  virtual std::size_t queued_bytes() const = 0;
};

// Starts to listen. Throws InvalidArgument when the address is not available, or is reachable by others
// without a token.
std::unique_ptr<WebServer> open_web_server(const WebServer::Options& options, WebHandlers handlers);

}  // namespace halocline::monitor
