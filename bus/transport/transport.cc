// SPDX-License-Identifier: BSD-3-Clause
#include "bus/transport/transport.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <mutex>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "bus/transport/datagram_filter.h"
#include "bus/transport/event_log.h"
#include "core/check.h"
#include "core/shared_module.h"

namespace halocline::bus {
namespace {

constexpr int kReceiveBufferBytes = 4'194'304;

// True when udpm://GROUP:PORT names a group and a port; LCM has defaults if neither is given.
bool names_a_group(const std::string& url) {
  const std::size_t begin = std::string_view("udpm://").size(), end = std::min(url.find('?'), url.size());
  if (end == begin) return true;
  in_addr group{};
  return inet_pton(AF_INET, url.substr(begin, url.rfind(':', end) - begin).c_str(), &group) == 1 &&
         IN_MULTICAST(ntohl(group.s_addr)) && port_of(url);
}

bool starts_with(std::string_view text, std::string_view prefix) {
  return text.substr(0, prefix.size()) == prefix;
}

}  // namespace

std::string effective_url(const std::string& given) {
  const char* from_environment = std::getenv("LCM_DEFAULT_URL");
  std::string url = given;
  if (url.empty() && from_environment != nullptr) url = from_environment;
  if (url.empty()) return std::string(kDefaultUrl);
  if (starts_with(url, "udpm://") && url.find("recv_buf_size") == std::string::npos) {
    url += (url.find('?') == std::string::npos ? "?" : "&");
    url += "recv_buf_size=" + std::to_string(kReceiveBufferBytes);
  }
  return url;
}

std::optional<std::uint16_t> port_of(const std::string& url) {
  const std::size_t colon = url.rfind(':');
  const std::size_t end = std::min(url.find('?'), url.size());
  const std::string port = colon < end ? url.substr(colon + 1, end - colon - 1) : "";
  const bool number =
      !port.empty() && port.size() < 6 && port.find_first_not_of("0123456789") == std::string::npos;
  if (!number || std::stoi(port) > 65535) return std::nullopt;
  return static_cast<std::uint16_t>(std::stoi(port));
}

std::string next_port(const std::string& url) {
  const auto port = port_of(url);
  require(port && *port < 65535, "LCM URL is '" + url + "'; lockstep needs udpm://GROUP:PORT?ttl=N");
  return url.substr(0, url.rfind(':') + 1) + std::to_string(*port + 1) +
         url.substr(std::min(url.find('?'), url.size()));
}

std::unique_ptr<lcm::LCM> open_transport(const std::string& url) {
  // tcpq without a server seems to work, but aborts in handleTimeout; a log file is read at the pace of the
  // wall clock.
  require((starts_with(url, "udpm://") && names_a_group(url)) || starts_with(url, "memq://"),
          "LCM URL is '" + url + "'; allowed are udpm://GROUP:PORT?ttl=N and memq://");
  auto lcm = std::make_unique<lcm::LCM>(url);
  if (!lcm->good()) {
    throw NetworkError(
        "LCM cannot open '" + url +
        "'. For udpm the host needs a multicast route: scripts/isolated COMMAND gives one on loopback");
  }
  return lcm;
}

void warn_of_missing_filter() {
  static std::once_flag once;
  std::call_once(once, [] {
    EventLog("bus").warning(
        "receive-filter-missing",
        std::string("reason=\"") + std::strerror(errno) +
            "\" open_to=\"any host, datagrams that end the process: docs/reliability.md, Firewall\"");
  });
}

std::string receive_buffer_warning(const std::string& url) {
  if (!starts_with(url, "udpm://")) return "";
  const int probe = socket(AF_INET, SOCK_DGRAM, 0);
  if (probe < 0) return "";
  const int requested = kReceiveBufferBytes;
  int granted = 0;
  socklen_t size = sizeof granted;
  setsockopt(probe, SOL_SOCKET, SO_RCVBUF, &requested, sizeof requested);
  getsockopt(probe, SOL_SOCKET, SO_RCVBUF, &granted, &size);
  close(probe);
  if (granted >= requested) return "";
  return "the kernel grants " + std::to_string(granted) + " bytes of receive buffer, " +
         std::to_string(requested) +
         " are needed to lose nothing in a burst; as root: sysctl -w net.core.rmem_max=" +
         std::to_string(requested);
}

}  // namespace halocline::bus

// Replaces the C library's bind() for calls from LCM, which is a shared library, and forwards to it. LCM
// offers no access to its socket, and reads from it before any of its calls returns; this is the only place
// where a filter can be attached in time.
extern "C" int bind(int socket, const sockaddr* address, socklen_t size) noexcept {
  using Bind = int (*)(int, const sockaddr*, socklen_t);
  static const auto next = reinterpret_cast<Bind>(halocline::next_symbol("bind"));
  namespace bus = halocline::bus;
  const bool is_of_lcm =
      halocline::library_of(__builtin_return_address(0)).find("liblcm") != std::string::npos;
  if (is_of_lcm && !bus::attach_filter(socket, bus::datagram_program())) bus::warn_of_missing_filter();
  return next(socket, address, size);
}
