// SPDX-License-Identifier: BSD-3-Clause
// Connections to the hosts of a modem gateway: reads and writes the bytes of all of them on one thread,
// without waiting for any.
//
// Every host is bounded, so that none disturbs another modem interface, whatever it does:
// - kMaxClients hosts at a modem interface; further ones are disconnected at once.
// - kMaxPiece bytes are read from a host in one call of take().
// - kMaxUnsent bytes are kept for a host that does not read. A write that does not fit is dropped whole, so
//   that a message is never cut.
//
// A pseudo-terminal has one host, from when it is opened until it is closed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "clients/modem_gateway/endpoint.h"
#include "clients/modem_gateway/gateway_config.h"
#include "clients/modem_gateway/protocols/protocol.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {

// Counts since the start, of all modem interfaces together.
struct ConnectionCounters {
  std::int64_t opened = 0, turned_away = 0;
  std::int64_t bytes_in = 0, bytes_out = 0;
  std::int64_t writes_dropped = 0;  // to hosts that do not read
};

class Connections {
 public:
  static constexpr std::size_t kMaxClients = 32, kMaxPiece = 16 * 1024, kMaxUnsent = 64 * 1024;
  // Period at which a pseudo-terminal that no host has open is polled: opening it raises no event of epoll.
  static constexpr SimDuration kPtyPeriod = SimDuration::from_milliseconds(50);

  Connections();

  // Opens a modem interface at `place` and returns its number: 0, 1, ... Throws InvalidArgument when the
  // place cannot be opened.
  std::size_t add(const Endpoint& place);
  // Returns the place as text, with the actual port where the place asked for any free one (port 0).
  std::string place_of(std::size_t interface) const;

  // Returns what hosts have done since the last call, in order. Never waits. `steady`: the present time of
  // the steady clock.
  enum class Change { kOpened, kBytes, kClosed };
  struct Input {
    std::size_t interface = 0;
    ClientId client = 0;
    Change change = Change::kBytes;
    std::string bytes;
  };
  std::vector<Input> take(SimTime steady);

  // Writes to one host, or with kAllClients to every host of the modem interface.
  void write(std::size_t interface, ClientId client, std::string_view bytes);

  // Shuts a TCP connection down; take() reports it as closed afterwards.
  void disconnect(ClientId client);

  // Sends a UDP datagram to `port` of the machine from which the host is connected by TCP. A datagram that
  // the network does not accept at once is lost.
  void send_datagram(ClientId client, std::uint16_t port, std::string_view bytes);

  // Returns a descriptor that is readable when take() has something to do, except for pseudo-terminals being
  // opened, which are polled.
  int ready_file() const { return epoll_.get(); }
  bool is_ready() const;
  // Returns the time (steady clock) of the next poll of pseudo-terminals; never() when none waits for a host.
  SimTime next_poll() const { return next_poll_; }

  const ConnectionCounters& counters() const { return counters_; }
  std::size_t clients() const { return clients_.size(); }

 private:
  struct Listener {
    Endpoint place;
    FileDescriptor listening;  // listening socket, or the gateway's side of the pseudo-terminal
    Link link;                 // symbolic link to the pseudo-terminal
    std::size_t num_clients = 0;
    bool is_waiting_pty = false;  // no host has the pseudo-terminal open
  };
  struct Client {
    std::size_t interface = 0;
    FileDescriptor connection;  // -1 on a pseudo-terminal, where the file of its Listener is used
    std::string unsent;
    bool watches_room = false;  // epoll also reports when the host can be written to
  };

  int file_of(const Client& client) const;
  void watch(int operation, int fd, std::uint64_t mark, std::uint32_t events) const;
  void accept_all(std::size_t interface, std::vector<Input>& inputs);
  ClientId open(std::size_t interface, FileDescriptor connection, std::vector<Input>& inputs);
  void poll_ptys(SimTime steady, std::vector<Input>& inputs);
  void serve(ClientId id, std::uint32_t events, std::vector<Input>& inputs);
  void close(ClientId id, std::vector<Input>& inputs);
  bool send_unsent(Client& client);
  void write_to(ClientId id, Client& client, std::string_view bytes);
  void follow_room(ClientId id, Client& client);

  FileDescriptor epoll_;
  FileDescriptor datagrams_;  // UDP socket, opened with the first datagram
  std::vector<Listener> listeners_;
  std::map<ClientId, Client> clients_;
  ClientId last_ = 0;
  SimTime next_poll_ = SimTime::never();
  ConnectionCounters counters_;
};

}  // namespace halocline::modem_gateway
