// SPDX-License-Identifier: BSD-3-Clause
// A network that loses, doubles and overtakes datagrams, for programs that know nothing of it: loaded before
// the C library (LD_PRELOAD), it stands in for sendto and sendmsg on datagram sockets. For machines whose
// kernel has no netem; what LCM sends goes through sendmsg and sendto alone.
//
// HALOCLINE_UDP_LOSS, _DOUBLING, _REORDERING: shares from 0 to 1. An overtaken datagram is sent after the
// next two.
#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include <dlfcn.h>
#include <sys/socket.h>
#include <sys/types.h>
#include <unistd.h>

namespace {

double share(const char* name) {
  const char* text = std::getenv(name);
  return text == nullptr ? 0 : std::atof(text);
}

struct Held {
  int socket;
  std::vector<char> bytes;
  sockaddr_storage to;
  socklen_t to_size;
  int others_first;
};

class Network {
 public:
  // How often a datagram is to be sent now: 0, 1 or 2.
  int copies(int socket, const void* bytes, std::size_t size, const sockaddr* to, socklen_t to_size) {
    const std::lock_guard lock(mutex_);
    const double drawn = draw_(random_);
    if (drawn < loss_) return 0;
    if (drawn < loss_ + reordering_ && !held_ && to != nullptr && to_size <= sizeof(sockaddr_storage)) {
      held_ = Held{socket, {}, {}, to_size, 2};
      held_->bytes.assign(static_cast<const char*>(bytes), static_cast<const char*>(bytes) + size);
      __builtin_memcpy(&held_->to, to, to_size);
      return 0;
    }
    return drawn > 1 - doubling_ ? 2 : 1;
  }
  // The datagram that has waited long enough, if there is one.
  std::optional<Held> take_overtaken() {
    const std::lock_guard lock(mutex_);
    if (!held_ || --held_->others_first > 0) return std::nullopt;
    std::optional<Held> taken = std::move(held_);
    held_.reset();
    return taken;
  }

 private:
  std::mutex mutex_;
  std::mt19937 random_{static_cast<unsigned>(getpid())};
  std::uniform_real_distribution<double> draw_{0, 1};
  const double loss_ = share("HALOCLINE_UDP_LOSS"), doubling_ = share("HALOCLINE_UDP_DOUBLING");
  const double reordering_ = share("HALOCLINE_UDP_REORDERING");
  std::optional<Held> held_;
};

Network& network() {
  static Network instance;
  return instance;
}

template <class Function>
Function original(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

bool is_datagram_socket(int socket) {
  int type = 0;
  socklen_t size = sizeof type;
  int domain = 0;
  socklen_t domain_size = sizeof domain;
  return getsockopt(socket, SOL_SOCKET, SO_TYPE, &type, &size) == 0 && type == SOCK_DGRAM &&
         getsockopt(socket, SOL_SOCKET, SO_DOMAIN, &domain, &domain_size) == 0 && domain == AF_INET;
}

using SendTo = ssize_t (*)(int, const void*, std::size_t, int, const sockaddr*, socklen_t);
using SendMessage = ssize_t (*)(int, const msghdr*, int);

void send_overtaken() {
  static const auto send = original<SendTo>("sendto");
  if (const auto held = network().take_overtaken()) {
    send(held->socket, held->bytes.data(), held->bytes.size(), 0,
         reinterpret_cast<const sockaddr*>(&held->to), held->to_size);
  }
}

}  // namespace

extern "C" ssize_t sendto(int socket, const void* bytes, std::size_t size, int flags, const sockaddr* to,
                          socklen_t to_size) {
  static const auto send = original<SendTo>("sendto");
  if (!is_datagram_socket(socket)) return send(socket, bytes, size, flags, to, to_size);
  ssize_t sent = static_cast<ssize_t>(size);
  for (int i = network().copies(socket, bytes, size, to, to_size); i > 0; --i)
    sent = send(socket, bytes, size, flags, to, to_size);
  send_overtaken();
  return sent;
}

extern "C" ssize_t sendmsg(int socket, const msghdr* message, int flags) {
  static const auto send = original<SendMessage>("sendmsg");
  if (!is_datagram_socket(socket)) return send(socket, message, flags);
  std::vector<char> bytes;
  for (std::size_t i = 0; i < message->msg_iovlen; ++i) {
    const auto* part = static_cast<const char*>(message->msg_iov[i].iov_base);
    bytes.insert(bytes.end(), part, part + message->msg_iov[i].iov_len);
  }
  ssize_t sent = static_cast<ssize_t>(bytes.size());
  const auto* to = static_cast<const sockaddr*>(message->msg_name);
  for (int i = network().copies(socket, bytes.data(), bytes.size(), to, message->msg_namelen); i > 0; --i)
    sent = send(socket, message, flags);
  send_overtaken();
  return sent;
}
