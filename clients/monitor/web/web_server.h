// SPDX-License-Identifier: BSD-3-Clause
// HTTP and WebSocket for the monitor's page: files of the bundle, and connections at /ws.
//
// One thread: callbacks come from run_for(), and everything is called from the thread that calls it. Nothing
// here waits for a client: what is sent is queued. Bounds, so that no client costs more than its share:
//
// - at most kMaxTransports TCP connections and kMaxConnections WebSockets; more are refused (503);
// - headers to 16 kB, requests without a body, messages to kMaxMessageBytes; ten seconds for a request;
// - a client that leaves kMaxQueuedBytes unread, or reads nothing for kMaxStall, is dropped, as is one that
//   does not answer pings for 20 s;
// - a client whose message was not taken (WebHandlers::received) is read no further until resume(), nor one
//   that leaves much unread: a flood waits in its own socket.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "clients/monitor/web/web_rules.h"

namespace halocline::monitor {

using ConnectionId = std::int64_t;
using SharedBytes = std::shared_ptr<const std::string>;

// By subprotocol: halocline.monitor.v1, foxglove.websocket.v1.
enum class WebProtocol { kMonitor, kFoxglove };

struct WebHandlers {
  std::function<void(ConnectionId, WebProtocol)> opened;
  // False when it cannot be handled now: it is offered again by resume().
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
    WebAccess access = {};  // port 0: any that is free
    std::string page = {};  // folder of the bundle
    int socket = -1;        // of listening_socket(), which it takes over; -1: it opens one
  };
  virtual ~WebServer() = default;

  // Of the page, with the token.
  virtual std::string url() const = 0;

  // Serves for so long.
  virtual void run_for(std::chrono::milliseconds duration) = 0;
  // Offers again what was not taken; drops who stalls.
  virtual void resume() = 0;

  // Ends a connection.
  virtual void close(ConnectionId id) = 0;
  // Queues one message; none for a connection that is gone. No callback comes of it.
  virtual void send(ConnectionId id, SharedBytes message, bool binary) = 0;
  // Whether everything sent has left for the network. False for a connection that is gone.
  virtual bool is_idle(ConnectionId id) const = 0;
  // Bytes that wait for all clients together.
  virtual std::size_t queued_bytes() const = 0;
};

// Listens. Throws InvalidArgument when the address cannot be had, and for one that others reach without a
// token.
std::unique_ptr<WebServer> open_web_server(const WebServer::Options& options, WebHandlers handlers);

}  // namespace halocline::monitor
