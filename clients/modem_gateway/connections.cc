// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/connections.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <iterator>
#include <utility>

#include <netinet/in.h>
#include <poll.h>
#include <sys/epoll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/check.h"

namespace halocline::modem_gateway {
namespace {

// Flag in the user data of an epoll event: set for the listening socket of a modem interface, whose number
// the other bits hold. Without it the data is the number of a host.
constexpr std::uint64_t kListenerMark = std::uint64_t{1} << 63;
constexpr int kMaxEvents = 256;

bool is_over(ssize_t result) {
  return result == 0 || (result < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR);
}

}  // namespace

Connections::Connections() : epoll_(epoll_create1(EPOLL_CLOEXEC)) {
  ensure(epoll_.get() >= 0, "no epoll");
  // Raises the limit of open files to the most that the process may have: accept() without a free descriptor
  // fails, and the listening socket then stays readable for ever.
  rlimit files{};
  if (getrlimit(RLIMIT_NOFILE, &files) == 0) {
    files.rlim_cur = files.rlim_max;
    setrlimit(RLIMIT_NOFILE, &files);
  }
}

void Connections::watch(int operation, int fd, std::uint64_t mark, std::uint32_t events) const {
  epoll_event event{};
  event.events = events;
  event.data.u64 = mark;
  epoll_ctl(epoll_.get(), operation, fd, &event);
}

std::size_t Connections::add(const Endpoint& place) {
  Listener listener;
  listener.place = place;
  if (place.is_tcp) {
    listener.listening = listen_tcp(place);
    watch(EPOLL_CTL_ADD, listener.listening.get(), kListenerMark | listeners_.size(), EPOLLIN);
    listener.place.port = port_of(listener.listening);
  } else {
    SerialLine line = open_pty(place.path);
    listener.listening = std::move(line.terminal);
    listener.link = std::move(line.link);
    listener.is_waiting_pty = true;
    next_poll_ = SimTime();
  }
  listeners_.push_back(std::move(listener));
  return listeners_.size() - 1;
}

std::string Connections::place_of(std::size_t interface) const {
  return listeners_.at(interface).place.text();
}

int Connections::file_of(const Client& client) const {
  return client.connection.get() >= 0 ? client.connection.get()
                                      : listeners_[client.interface].listening.get();
}

bool Connections::is_ready() const {
  pollfd ready{epoll_.get(), POLLIN, 0};
  return poll(&ready, 1, 0) > 0;
}

std::vector<Connections::Input> Connections::take(SimTime steady) {
  std::vector<Input> inputs;
  if (steady >= next_poll_) poll_ptys(steady, inputs);
  std::array<epoll_event, kMaxEvents> events{};
  const int count = epoll_wait(epoll_.get(), events.data(), kMaxEvents, 0);
  for (int i = 0; i < count; ++i) {
    const epoll_event& event = events[static_cast<std::size_t>(i)];
    if ((event.data.u64 & kListenerMark) != 0)
      accept_all(static_cast<std::size_t>(event.data.u64 & ~kListenerMark), inputs);
    else
      serve(static_cast<ClientId>(event.data.u64), event.events, inputs);
  }
  return inputs;
}

void Connections::accept_all(std::size_t interface, std::vector<Input>& inputs) {
  for (;;) {
    FileDescriptor connection = accept_connection(listeners_[interface].listening);
    if (connection.get() < 0) return;
    if (listeners_[interface].num_clients < kMaxClients)
      open(interface, std::move(connection), inputs);
    else
      ++counters_.turned_away;  // closed at once
  }
}

ClientId Connections::open(std::size_t interface, FileDescriptor connection, std::vector<Input>& inputs) {
  const ClientId id = ++last_;
  Client& client = clients_[id] = {interface, std::move(connection), {}};
  watch(EPOLL_CTL_ADD, file_of(client), static_cast<std::uint64_t>(id), EPOLLIN);
  ++listeners_[interface].num_clients;
  ++counters_.opened;
  inputs.push_back({interface, id, Change::kOpened, {}});
  return id;
}

void Connections::poll_ptys(SimTime steady, std::vector<Input>& inputs) {
  next_poll_ = SimTime::never();
  for (std::size_t i = 0; i < listeners_.size(); ++i) {
    Listener& listener = listeners_[i];
    if (!listener.is_waiting_pty) continue;
    if (is_pty_open(listener.listening)) {
      listener.is_waiting_pty = false;
      open(i, FileDescriptor(), inputs);
    } else {
      next_poll_ = steady + kPtyPeriod;
    }
  }
}

void Connections::serve(ClientId id, std::uint32_t events, std::vector<Input>& inputs) {
  const auto found = clients_.find(id);
  if (found == clients_.end()) return;
  Client& client = found->second;
  bool is_gone = (events & EPOLLOUT) != 0 && !send_unsent(client);
  if (!is_gone && (events & (EPOLLIN | EPOLLHUP | EPOLLERR)) != 0) {
    std::string bytes(kMaxPiece, '\0');
    const ssize_t size = read(file_of(client), bytes.data(), bytes.size());
    is_gone = is_over(size);
    if (size > 0) {
      bytes.resize(static_cast<std::size_t>(size));
      counters_.bytes_in += size;
      inputs.push_back({client.interface, id, Change::kBytes, std::move(bytes)});
    }
  }
  if (is_gone) return close(id, inputs);
  follow_room(id, client);
}

void Connections::close(ClientId id, std::vector<Input>& inputs) {
  const auto found = clients_.find(id);
  const std::size_t number = found->second.interface;
  Listener& listener = listeners_[number];
  watch(EPOLL_CTL_DEL, file_of(found->second), 0, 0);
  if (!listener.place.is_tcp) {
    listener.is_waiting_pty = true;
    next_poll_ = SimTime();
  }
  clients_.erase(found);
  --listener.num_clients;
  inputs.push_back({number, id, Change::kClosed, {}});
}

void Connections::write(std::size_t interface, ClientId client, std::string_view bytes) {
  if (client != kAllClients) {
    const auto found = clients_.find(client);
    if (found != clients_.end()) write_to(client, found->second, bytes);
    return;
  }
  for (auto& [id, each] : clients_) {
    if (each.interface == interface) write_to(id, each, bytes);
  }
}

void Connections::disconnect(ClientId client) {
  const auto found = clients_.find(client);
  if (found != clients_.end()) shutdown(found->second.connection.get(), SHUT_RDWR);
}

void Connections::send_datagram(ClientId client, std::uint16_t port, std::string_view bytes) {
  const auto found = clients_.find(client);
  if (found == clients_.end()) return;
  sockaddr_in address{};
  socklen_t size = sizeof address;
  auto* any = reinterpret_cast<sockaddr*>(&address);
  if (getpeername(found->second.connection.get(), any, &size) != 0) return;  // a pseudo-terminal
  if (datagrams_.get() < 0)
    datagrams_ = FileDescriptor(socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  address.sin_port = htons(port);
  if (sendto(datagrams_.get(), bytes.data(), bytes.size(), 0, any, sizeof address) > 0)
    counters_.bytes_out += std::ssize(bytes);
}

void Connections::write_to(ClientId id, Client& client, std::string_view bytes) {
  if (client.unsent.size() + bytes.size() > kMaxUnsent) {
    ++counters_.writes_dropped;
    return;
  }
  client.unsent += bytes;
  send_unsent(client);  // a disconnected host is noticed when it is next read
  follow_room(id, client);
}

// Writes as much of the unsent bytes as the host takes now. Returns false when the host has disconnected.
bool Connections::send_unsent(Client& client) {
  while (!client.unsent.empty()) {
    const bool is_socket = client.connection.get() >= 0;
    const ssize_t size =
        is_socket ? send(client.connection.get(), client.unsent.data(), client.unsent.size(), MSG_NOSIGNAL)
                  : ::write(file_of(client), client.unsent.data(), client.unsent.size());
    if (size <= 0) return !is_over(size);
    counters_.bytes_out += size;
    client.unsent.erase(0, static_cast<std::size_t>(size));
  }
  return true;
}

void Connections::follow_room(ClientId id, Client& client) {
  const bool wants_room = !client.unsent.empty();
  if (wants_room == client.watches_room) return;
  client.watches_room = wants_room;
  watch(EPOLL_CTL_MOD, file_of(client), static_cast<std::uint64_t>(id),
        wants_room ? EPOLLIN | EPOLLOUT : EPOLLIN);
}

}  // namespace halocline::modem_gateway
