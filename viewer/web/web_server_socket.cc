// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/web/web_server_socket.h"

#include <string>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "core/check.h"

namespace halocline::monitor {

namespace asio = boost::asio;

int listening_socket(WebAccess& access) {
  boost::system::error_code error;
  const auto address =
      asio::ip::make_address(access.address == "localhost" ? "127.0.0.1" : access.address, error);
  require(!error, "--address is '" + access.address + "'; allowed is an IP address");
  require(is_loopback(access.address) || !access.token.empty(),
          "--address is " + access.address + ", which others reach; then a --token is needed");
  try {
    asio::io_context io;
    asio::ip::tcp::acceptor acceptor(io, asio::ip::tcp::endpoint(address, access.port), /*reuse_addr=*/true);
    access.port = acceptor.local_endpoint().port();
    return acceptor.release();
  } catch (const boost::system::system_error& problem) {
    throw InvalidArgument("cannot listen on " + access.address + ", port " + std::to_string(access.port) +
                          ": " + problem.code().message());
  }
}

}  // namespace halocline::monitor
