// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/web/web_server.h"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "core/check.h"
#include "tests/viewer/web_client.h"

namespace halocline::monitor {
namespace {

using std::chrono::milliseconds;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::host_of;
using ::testing::Not;
using ::testing::StartsWith;
using testing::WebClient;

constexpr char kProtocol[] = "Sec-WebSocket-Protocol: halocline.monitor.v1\r\n";

// A server in a thread of its own that answers each message with what `answer` makes of it.
class RunningServer {
 public:
  explicit RunningServer(WebServer::Options options = {}) {
    page_ = std::filesystem::temp_directory_path() / ("halocline_page_" + std::to_string(::getpid()));
    std::filesystem::create_directories(page_ / "assets");
    std::ofstream(page_ / "index.html") << "<title>bundle</title>";
    std::ofstream(page_ / "assets/a-1.js") << "export {}";
    if (options.page.empty()) options.page = page_.string();
    server_ = open_web_server(options,
                              {.opened = [this](ConnectionId id, WebProtocol) { open_.push_back(id); },
                               .received =
                                   [this](ConnectionId id, std::string_view message, bool binary) {
                                     if (refuses_) return false;
                                     ++received_;
                                     server_->send(id, std::make_shared<const std::string>(message), binary);
                                     return true;
                                   },
                               .closed = [this](ConnectionId id) { std::erase(open_, id); }});
    port_ = static_cast<std::uint16_t>(std::stoi(server_->url().substr(server_->url().rfind(':') + 1)));
    thread_ = std::thread([this] {
      while (!stop_) {
        server_->run_for(milliseconds(10));
        server_->resume();
        for (const ConnectionId id : open_) {
          if (floods_) server_->send(id, std::make_shared<const std::string>(100'000, 'x'), true);
        }
        connections_ = open_.size();
        queued_ = std::max(queued_.load(), server_->queued_bytes());
      }
    });
  }
  ~RunningServer() {
    stop_ = true;
    thread_.join();
    std::filesystem::remove_all(page_);
  }
  RunningServer(const RunningServer&) = delete;
  RunningServer& operator=(const RunningServer&) = delete;

  std::uint16_t port() const { return port_; }
  bool has_connections(std::size_t count) const {
    for (int i = 0; i < 500 && connections_ != count; ++i) std::this_thread::sleep_for(milliseconds(10));
    return connections_ == count;
  }

  std::atomic<bool> floods_ = false, refuses_ = false;
  std::atomic<std::size_t> queued_ = 0, received_ = 0;

 private:
  std::filesystem::path page_;
  std::unique_ptr<WebServer> server_;
  std::uint16_t port_ = 0;
  std::vector<ConnectionId> open_;
  std::atomic<std::size_t> connections_ = 0;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

std::string get(const RunningServer& server, const std::string& target) {
  return WebClient(server.port()).request("GET " + target, host_of(server.port()));
}

TEST(WebServer, ServesTheBundle) {
  const RunningServer server;
  EXPECT_THAT(get(server, "/"), HasSubstr("<title>bundle</title>"));
  EXPECT_THAT(get(server, "/assets/a-1.js"), HasSubstr("Cache-Control: public, max-age=31536000, immutable"));
  EXPECT_THAT(get(server, "/nothing.js"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(get(server, "/../../../etc/passwd"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(WebClient(server.port()).request("POST /", host_of(server.port())), StartsWith("HTTP/1.1 405"));
  EXPECT_THAT(WebClient(server.port()).request("HEAD /", host_of(server.port())),
              HasSubstr("Content-Length: 21\r\n"));
}

TEST(WebServer, WithoutABundleNamesTheCommand) {
  const RunningServer server({.page = "/nowhere"});
  EXPECT_THAT(get(server, "/"), HasSubstr("./scripts/monitor"));
}

TEST(WebServer, LinkOutOfTheBundleIsNotFollowed) {
  const RunningServer server;
  const auto page = std::filesystem::temp_directory_path() / ("halocline_page_" + std::to_string(::getpid()));
  std::filesystem::create_symlink("/etc/passwd", page / "secret.txt");
  EXPECT_THAT(get(server, "/secret.txt"), StartsWith("HTTP/1.1 404"));
}

TEST(WebServer, AnotherHostIsForbidden) {
  const RunningServer server;
  EXPECT_THAT(WebClient(server.port()).request("GET /", "Host: evil.example\r\n"),
              StartsWith("HTTP/1.1 403"));
  WebClient client(server.port());
  EXPECT_EQ(client.open("/ws", host_of(server.port()) + kProtocol + "Origin: http://evil.example\r\n"),
            "HTTP/1.1 403 Forbidden");
  EXPECT_THAT(WebClient(server.port()).request("GET /", host_of(server.port()) + "Host: evil.example\r\n"),
              StartsWith("HTTP/1.1 400"));
}

TEST(WebServer, AddressThatOthersReachNeedsAToken) {
  EXPECT_THROW(open_web_server({.access = {.address = "0.0.0.0"}}, {}), InvalidArgument);
  EXPECT_THROW(open_web_server({.access = {.address = "sea"}}, {}), InvalidArgument);
}

TEST(WebServer, TokenComesWithTheUrlAndThenByCookie) {
  const RunningServer server({.access = {.token = "abc"}});
  EXPECT_THAT(get(server, "/"), StartsWith("HTTP/1.1 401"));
  EXPECT_THAT(get(server, "/?token=abd"), StartsWith("HTTP/1.1 401"));
  EXPECT_THAT(get(server, "/?token=abd"), HasSubstr("not the token of this monitor"));
  EXPECT_THAT(get(server, "/"), AllOf(StartsWith("HTTP/1.1 401"), HasSubstr("<form"), Not(HasSubstr("abc"))));
  EXPECT_THAT(get(server, "/assets/a-1.js"), AllOf(StartsWith("HTTP/1.1 401"), Not(HasSubstr("<form"))));
  const std::string answer = get(server, "/?token=abc");
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 200"));
  const std::string cookie = "halocline_token_" + std::to_string(server.port()) + "=abc";
  EXPECT_THAT(answer, HasSubstr("Set-Cookie: " + cookie + "; Path=/; HttpOnly; SameSite=Strict"));
  WebClient client(server.port());
  EXPECT_EQ(client.open("/ws", host_of(server.port()) + kProtocol), "HTTP/1.1 401 Unauthorized");
  WebClient with_cookie(server.port());
  EXPECT_EQ(with_cookie.open("/ws", host_of(server.port()) + kProtocol + "Cookie: " + cookie + "\r\n"),
            "HTTP/1.1 101 Switching Protocols");
}

TEST(WebServer, MessagesPassBothWays) {
  const RunningServer server;
  WebClient client(server.port());
  ASSERT_EQ(client.open("/ws", host_of(server.port()) + kProtocol), "HTTP/1.1 101 Switching Protocols");
  client.send_message("depth", false);
  client.send_message(std::string(60'000, 'd'), true);
  const auto first = client.next(), second = client.next();
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->bytes, "depth");
  EXPECT_FALSE(first->binary);
  EXPECT_EQ(second->bytes.size(), 60'000U);
  EXPECT_TRUE(second->binary);
}

TEST(WebServer, UnknownProtocolIsRefused) {
  const RunningServer server;
  WebClient client(server.port());
  EXPECT_EQ(client.open("/ws", host_of(server.port()) + "Sec-WebSocket-Protocol: chat\r\n"),
            "HTTP/1.1 400 Bad Request");
  EXPECT_THAT(get(server, "/ws"), StartsWith("HTTP/1.1 426"));
}

TEST(WebServer, MalformedAndHugeFramesEndTheirConnectionAlone) {
  const RunningServer server;
  WebClient good(server.port());
  ASSERT_EQ(good.open("/ws", host_of(server.port()) + kProtocol), "HTTP/1.1 101 Switching Protocols");
  std::string unmasked = "\x81\x01x";
  std::string wrong_opcode = testing::frame("x", 5);
  std::string endless = std::string("\x82\xff\x7f\xff\xff\xff\xff\xff\xff\xff", 10) + "mask";
  std::string not_utf8 = testing::frame("\xff\xfe", 1);
  for (const std::string& bytes : {unmasked, wrong_opcode, endless, not_utf8,
                                   testing::frame(std::string(100'000, 'x'), 2), std::string(1000, '\0')}) {
    WebClient bad(server.port());
    ASSERT_EQ(bad.open("/ws", host_of(server.port()) + kProtocol), "HTTP/1.1 101 Switching Protocols");
    bad.send(bytes);
    EXPECT_TRUE(bad.is_closed());
  }
  for (const std::string& bytes :
       {std::string("GET / HTTP/9.9\r\n\r\n"), std::string("\x16\x03\x01\x00\xff", 5),
        "GET / HTTP/1.1\r\nX: " + std::string(40'000, 'a')}) {
    const WebClient bad(server.port());
    bad.send(bytes + "\r\n\r\n");
    EXPECT_TRUE(bad.is_closed());
  }
  good.send_message("still here");
  EXPECT_EQ(good.next()->bytes, "still here");
}

TEST(WebServer, ManyConnectionsAreRefusedAndLeaveRoomAgain) {
  const RunningServer server;
  {
    std::vector<std::unique_ptr<WebClient>> clients;
    for (std::size_t i = 0; i < WebServer::kMaxConnections; ++i) {
      clients.push_back(std::make_unique<WebClient>(server.port()));
      ASSERT_EQ(clients.back()->open("/ws", host_of(server.port()) + kProtocol),
                "HTTP/1.1 101 Switching Protocols");
    }
    WebClient one_more(server.port());
    EXPECT_EQ(one_more.open("/ws", host_of(server.port()) + kProtocol), "HTTP/1.1 503 Service Unavailable");
    for (std::size_t i = 0; i < 2 * WebServer::kMaxTransports; ++i)
      clients.push_back(std::make_unique<WebClient>(server.port()));
    EXPECT_TRUE(WebClient(server.port()).is_closed());
  }
  EXPECT_TRUE(server.has_connections(0));
  EXPECT_THAT(get(server, "/"), HasSubstr("bundle"));
}

TEST(WebServer, ClientThatNeverReadsIsDroppedWithinItsBound) {
  RunningServer server;
  WebClient stalled(server.port());
  ASSERT_EQ(stalled.open("/ws", host_of(server.port()) + kProtocol), "HTTP/1.1 101 Switching Protocols");
  ASSERT_TRUE(server.has_connections(1));
  server.floods_ = true;
  ASSERT_TRUE(server.has_connections(0));
  EXPECT_LE(server.queued_, WebServer::kMaxQueuedBytes + 200'000);
}

TEST(WebServer, WhatWasNotTakenWaitsInTheClientsSocket) {
  RunningServer server;
  WebClient client(server.port());
  ASSERT_EQ(client.open("/ws", host_of(server.port()) + kProtocol), "HTTP/1.1 101 Switching Protocols");
  server.refuses_ = true;
  for (int i = 0; i < 20; ++i) client.send_message(std::to_string(i));
  EXPECT_FALSE(client.next(milliseconds(200)));
  EXPECT_EQ(server.received_, 0U);
  server.refuses_ = false;
  for (int i = 0; i < 20; ++i) EXPECT_EQ(client.next()->bytes, std::to_string(i));
}

}  // namespace
}  // namespace halocline::monitor
