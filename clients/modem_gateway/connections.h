// SPDX-License-Identifier: BSD-3-Clause
// The hosts that are connected to the doors of a gateway: all their bytes, on one thread, without waiting for
// any of them.
//
// Bounds: kMaxClients hosts a door, others are turned away; kMaxPiece bytes of a host in a call of take();
// kMaxUnsent bytes that a host does not read: what does not fit is dropped, each write whole, so that a
// message is never cut. So no host disturbs another door, whatever it does. A pseudo-terminal has one host,
// from when it is opened until it is closed.
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

struct ConnectionCounters {
  std::int64_t opened = 0, turned_away = 0;
  std::int64_t bytes_in = 0, bytes_out = 0;
  std::int64_t writes_dropped = 0;  // to hosts that do not read
};

class Connections {
 public:
  static constexpr std::size_t kMaxClients = 32, kMaxPiece = 16 * 1024, kMaxUnsent = 64 * 1024;
  // How often a pseudo-terminal that nobody has open is looked at.
  static constexpr SimDuration kPtyPeriod = SimDuration::from_milliseconds(50);

  Connections();

  // Opens a door at `place` and returns its number: 0, 1, ... Throws InvalidArgument where that is
  // impossible.
  std::size_t add(const Place& place);
  // With the port that was free, where the place left it open.
  std::string place_of(std::size_t door) const;

  // What hosts have done since the last call, in turn. Never waits.
  enum class Change { kOpened, kBytes, kClosed };
  struct Input {
    std::size_t door = 0;
    ClientId client = 0;
    Change change = Change::kBytes;
    std::string bytes;
  };
  std::vector<Input> take(SimTime steady);

  // To a host, or with kAllClients to all of the door.
  void write(std::size_t door, ClientId client, std::string_view bytes);

  // Ends a connection on TCP: take() reports it as closed.
  void disconnect(ClientId client);

  // By UDP, to that port of the machine that a host on TCP is on; what the network does not take at once is
  // lost.
  void send_datagram(ClientId client, std::uint16_t port, std::string_view bytes);

  // Readable when take() has something to do, but for pseudo-terminals that are opened.
  int ready_file() const { return epoll_.get(); }
  bool is_ready() const;
  // Of the look at pseudo-terminals (steady); never() without one that waits for a host.
  SimTime next_look() const { return next_look_; }

  const ConnectionCounters& counters() const { return counters_; }
  std::size_t clients() const { return clients_.size(); }

 private:
  struct Door {
    Place place;
    File listening;  // or the pseudo-terminal
    Link link;       // to the latter
    std::size_t num_clients = 0;
    bool is_waiting_pty = false;  // that nobody has open
  };
  struct Client {
    std::size_t door = 0;
    File connection;  // none of a pseudo-terminal: its door's
    std::string unsent;
    bool watches_room = false;  // epoll reports when it can be written to
  };

  int file_of(const Client& client) const;
  void watch(int operation, int fd, std::uint64_t mark, std::uint32_t events) const;
  void accept_all(std::size_t door, std::vector<Input>& inputs);
  ClientId open(std::size_t door, File connection, std::vector<Input>& inputs);
  void look_at_ptys(SimTime steady, std::vector<Input>& inputs);
  void serve(ClientId id, std::uint32_t events, std::vector<Input>& inputs);
  void close(ClientId id, std::vector<Input>& inputs);
  bool send_unsent(Client& client);
  void write_to(ClientId id, Client& client, std::string_view bytes);
  void follow_room(ClientId id, Client& client);

  File epoll_;
  File datagrams_;  // none before the first
  std::vector<Door> doors_;
  std::map<ClientId, Client> clients_;
  ClientId last_ = 0;
  SimTime next_look_ = SimTime::never();
  ConnectionCounters counters_;
};

}  // namespace halocline::modem_gateway
