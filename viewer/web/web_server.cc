// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/web/web_server.h"

#include <algorithm>
#include <deque>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include "core/check.h"
#include "viewer/web/web_files.h"
#include "viewer/web/web_server_socket.h"

namespace halocline::monitor {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;
using Request = http::request<http::empty_body>;
using Response = http::response<http::string_body>;

constexpr std::chrono::seconds kRequestTime{10}, kIdleTime{30}, kPingTime{20};
constexpr std::size_t kMaxHeaderBytes = 16 * 1024;
// Number of queued bytes beyond which a connection is not read.
constexpr std::size_t kEnoughQueuedBytes = 256 * 1024;
constexpr std::string_view kMonitorProtocol = "halocline.monitor.v1",
                           kFoxgloveProtocol = "foxglove.websocket.v1";

std::string_view view_of(beast::string_view text) { return {text.data(), text.size()}; }

WebRequest parts_of(const Request& request) {
  return {.target = view_of(request.target()),
          .host = view_of(request[http::field::host]),
          .origin = view_of(request[http::field::origin]),
          .authorization = view_of(request[http::field::authorization]),
          .cookie = view_of(request[http::field::cookie])};
}

Response response_of(WebAnswer answer) {
  const auto text = [](std::string_view view) { return beast::string_view(view.data(), view.size()); };
  Response response(static_cast<http::status>(answer.status), 11);
  response.set(http::field::content_type, text(answer.type));
  response.set(http::field::cache_control, text(answer.cache));
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");  // the URL may hold the token
  response.set("Content-Security-Policy",
               "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; "
               "worker-src 'self' blob:; frame-ancestors 'none'");
  if (answer.status == 401) response.set(http::field::www_authenticate, "Bearer");
  if (!answer.cookie.empty()) response.set(http::field::set_cookie, answer.cookie);
  response.body() = std::move(answer.body);
  return response;
}

class BeastServer : public WebServer {
 public:
  BeastServer(const Options& options, WebHandlers handlers);
  ~BeastServer() override;

  std::string url() const override { return url_of(options_.access); }
  void close(ConnectionId id) override;
  void run_for(std::chrono::milliseconds duration) override {
    io_.restart();
    io_.run_for(duration);
  }
  void resume() override;
  void send(ConnectionId id, SharedBytes message, bool binary) override;
  bool is_idle(ConnectionId id) const override;
  std::size_t queued_bytes() const override;

 private:
  class Exchange;
  class Connection;

  void accept();
  void open(beast::tcp_stream stream, const Request& request, WebProtocol protocol);
  void remove(ConnectionId id);
  std::shared_ptr<Connection> find(ConnectionId id) const;

  Options options_;
  WebHandlers handlers_;
  std::size_t transports_ = 0;  // declared first: outlives the connections in io_
  asio::io_context io_{1};
  asio::ip::tcp::acceptor acceptor_{io_};
  ConnectionId last_id_ = 0;
  std::size_t turns_ = 0;
  std::map<ConnectionId, std::shared_ptr<Connection>> connections_;
};

// HTTP requests of one TCP connection, until it ends or becomes a WebSocket.
class BeastServer::Exchange : public std::enable_shared_from_this<Exchange> {
 public:
  Exchange(BeastServer& server, asio::ip::tcp::socket socket) : server_(server), stream_(std::move(socket)) {
    ++server_.transports_;
  }
  ~Exchange() { --server_.transports_; }

  void read() {
    parser_.emplace();
    parser_->header_limit(kMaxHeaderBytes);
    parser_->body_limit(0);
    stream_.expires_after(is_first_ ? kRequestTime : kIdleTime);
    is_first_ = false;
    http::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](error_code error, std::size_t) {
      if (!error) self->answer(self->parser_->release());
    });
  }

 private:
  void answer(const Request& request) {
    if (request.count(http::field::host) > 1 || request.count(http::field::origin) > 1)
      return write(request, {400, "Host and Origin are given once.\n"});
    const WebRequest parts = parts_of(request);
    const WebAccess& access = server_.options_.access;
    const bool opens = websocket::is_upgrade(request) && path_of(parts.target) == "/ws" &&
                       judge(access, parts) == WebVerdict::kAllowed;
    if (opens) return upgrade(request);
    write(request, answer_to(access, server_.options_.page, view_of(request.method_string()), parts));
  }

  void upgrade(const Request& request) {
    const std::string_view chosen = choose_protocol(view_of(request[http::field::sec_websocket_protocol]),
                                                    {kMonitorProtocol, kFoxgloveProtocol});
    if (chosen.empty())
      return write(request, {400, "Subprotocols are halocline.monitor.v1 and foxglove.websocket.v1.\n"});
    if (server_.connections_.size() >= kMaxConnections)
      return write(request, {503, "Too many pages are open.\n"});
    stream_.expires_never();
    server_.open(std::move(stream_), request,
                 chosen == kMonitorProtocol ? WebProtocol::kMonitor : WebProtocol::kFoxglove);
  }

  void write(const Request& request, WebAnswer answer) {
    response_ = response_of(std::move(answer));
    response_.version(request.version());
    response_.keep_alive(request.keep_alive() && response_.result() == http::status::ok);
    response_.prepare_payload();
    if (request.method() == http::verb::head) response_.body().clear();
    stream_.expires_after(kIdleTime);
    http::async_write(stream_, response_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error || !self->response_.keep_alive()) return;  // the last reference ends the connection
      self->response_ = {};
      self->read();
    });
  }

  BeastServer& server_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{kMaxHeaderBytes + 1024};
  std::optional<http::request_parser<http::empty_body>> parser_;
  Response response_;
  bool is_first_ = true;
};

class BeastServer::Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(BeastServer& server, ConnectionId id, WebProtocol protocol, beast::tcp_stream stream)
      : server_(server), id_(id), protocol_(protocol), socket_(std::move(stream)) {}

  void accept(const Request& request) {
    socket_.set_option(websocket::stream_base::timeout{kRequestTime, kPingTime, /*keep_alive_pings=*/true});
    const std::string_view name = protocol_ == WebProtocol::kMonitor ? kMonitorProtocol : kFoxgloveProtocol;
    socket_.set_option(websocket::stream_base::decorator([name](websocket::response_type& response) {
      response.set(http::field::sec_websocket_protocol, beast::string_view(name.data(), name.size()));
    }));
    socket_.read_message_max(kMaxMessageBytes);
    socket_.auto_fragment(false);
    socket_.async_accept(request, [self = shared_from_this()](error_code error) {
      if (error) return self->drop();
      self->is_open_ = true;
      self->server_.handlers_.opened(self->id_, self->protocol_);
      self->read();
      self->write();
    });
  }

  // Offers again a message that was refused; drops a client that has stalled.
  void resume() {
    if (overflows_ || (is_writing_ && Clock::now() - write_began_ > kMaxStall)) return drop();
    if (waits_ && is_open_) offer();
  }

  void send(SharedBytes message, bool binary) {
    if (is_gone_ || overflows_) return;
    queued_bytes_ += message->size();
    queue_.push_back({std::move(message), binary});
    // One large message may exceed the bound, provided that no others wait before it.
    overflows_ = overflows_ || (queued_bytes_ > kMaxQueuedBytes && queue_.size() > 1);
    write();
  }

  bool is_idle() const { return is_open_ && !is_gone_ && queue_.empty(); }
  std::size_t queued_bytes() const { return queued_bytes_; }

  void drop() {
    if (is_gone_) return;
    is_gone_ = true;
    beast::get_lowest_layer(socket_).close();
    server_.remove(id_);
  }

 private:
  struct Queued {
    SharedBytes message;
    bool binary;
  };

  void read() {
    if (is_gone_) return;
    buffer_.consume(buffer_.size());
    socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
      if (self->is_gone_) return;
      if (error) return self->drop();
      self->offer();
    });
  }

  void offer() {
    const auto bytes = buffer_.cdata();
    const std::string_view message(static_cast<const char*>(bytes.data()), bytes.size());
    waits_ =
        queued_bytes_ > kEnoughQueuedBytes || !server_.handlers_.received(id_, message, socket_.got_binary());
    if (!waits_) read();
  }

  void write() {
    if (!is_open_ || is_gone_ || is_writing_ || queue_.empty()) return;
    is_writing_ = true;
    write_began_ = Clock::now();
    socket_.binary(queue_.front().binary);
    socket_.async_write(asio::buffer(*queue_.front().message),
                        [self = shared_from_this()](error_code error, std::size_t) {
                          if (self->is_gone_) return;
                          if (error) return self->drop();
                          self->is_writing_ = false;
                          self->queued_bytes_ -= self->queue_.front().message->size();
                          self->queue_.pop_front();
                          self->write();
                        });
  }

  BeastServer& server_;
  ConnectionId id_;
  WebProtocol protocol_;
  websocket::stream<beast::tcp_stream> socket_;
  beast::flat_buffer buffer_;
  std::deque<Queued> queue_;
  std::size_t queued_bytes_ = 0;
  Clock::time_point write_began_;
  bool is_open_ = false, is_gone_ = false, is_writing_ = false, overflows_ = false, waits_ = false;
};

BeastServer::BeastServer(const Options& options, WebHandlers handlers)
    : options_(options), handlers_(std::move(handlers)) {
  if (options_.socket < 0) options_.socket = listening_socket(options_.access);
  const bool is_v6 = options_.access.address.find(':') != std::string::npos;
  acceptor_.assign(is_v6 ? asio::ip::tcp::v6() : asio::ip::tcp::v4(), options_.socket);
  accept();
}

BeastServer::~BeastServer() {
  handlers_.closed = [](ConnectionId) {};
  while (!connections_.empty()) connections_.begin()->second->drop();
}

void BeastServer::accept() {
  acceptor_.async_accept([this](error_code error, asio::ip::tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    // A connection beyond the limit is closed when `socket` goes out of scope.
    if (!error && transports_ + connections_.size() < kMaxTransports) {
      socket.set_option(asio::ip::tcp::no_delay(true), error);
      std::make_shared<Exchange>(*this, std::move(socket))->read();
    }
    accept();
  });
}

void BeastServer::open(beast::tcp_stream stream, const Request& request, WebProtocol protocol) {
  const ConnectionId id = ++last_id_;
  connections_[id] = std::make_shared<Connection>(*this, id, protocol, std::move(stream));
  connections_[id]->accept(request);
}

void BeastServer::remove(ConnectionId id) {
  const auto kept = connections_.extract(id);  // kept until its own function has returned
  if (!kept.empty()) handlers_.closed(id);
}

void BeastServer::resume() {
  std::vector<std::shared_ptr<Connection>> all;
  for (const auto& [id, connection] : connections_) all.push_back(connection);
  // Each call begins with another connection, so that one that floods does not take the time of all.
  if (!all.empty())
    std::rotate(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(++turns_ % all.size()), all.end());
  for (const auto& connection : all) connection->resume();
}

std::shared_ptr<BeastServer::Connection> BeastServer::find(ConnectionId id) const {
  const auto found = connections_.find(id);
  return found == connections_.end() ? nullptr : found->second;
}

void BeastServer::close(ConnectionId id) {
  if (const auto connection = find(id)) connection->drop();
}
void BeastServer::send(ConnectionId id, SharedBytes message, bool binary) {
  if (const auto connection = find(id)) connection->send(std::move(message), binary);
}
bool BeastServer::is_idle(ConnectionId id) const {
  const auto connection = find(id);
  return connection != nullptr && connection->is_idle();
}

std::size_t BeastServer::queued_bytes() const {
  std::size_t bytes = 0;
  for (const auto& [id, connection] : connections_) bytes += connection->queued_bytes();
  return bytes;
}

}  // namespace

std::unique_ptr<WebServer> open_web_server(const WebServer::Options& options, WebHandlers handlers) {
  return std::make_unique<BeastServer>(options, std::move(handlers));
}

}  // namespace halocline::monitor
