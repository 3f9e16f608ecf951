// SPDX-License-Identifier: BSD-3-Clause
// Packet filter in the kernel that drops datagrams of channels without a local subscriber, and malformed ones
// (bus/transport/datagram_filter.h), so that they neither wake a thread nor fill a buffer.
//
// LCM receives every datagram of its bus and then discards those that nobody wants, at the cost of two system
// calls each. A classic packet filter (McCanne and Jacobson 1993, "The BSD packet filter") on LCM's socket
// compares the channel name in the datagram. Larger messages, which LCM divides into fragments, pass whatever
// their channel. The kernel counts dropped datagrams in InErrors of /proc/net/snmp and in the drops of
// /proc/net/udp; losses of a full buffer are in RcvbufErrors.
//
// LCM binds to every interface of a host, so its port receives datagrams of any host that can reach it,
// whatever the ttl. The filter also drops those of hosts that are not accepted. Source addresses can be
// forged on a network that permits it; this host is recognised by how a datagram came in, not by its address.
#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "bus/transport/datagram_filter.h"
#include "bus/transport/subscription.h"

namespace halocline::bus {

// Hosts whose datagrams are received, besides this one.
struct AcceptedHosts {
  struct Range {
    std::uint32_t address = 0, mask = 0;  // IPv4, host byte order
  };
  bool any = true;
  std::vector<Range> ranges;  // used if not any
};
// `text` is "any", or IPv4 addresses and ranges separated by commas ("10.0.3.7, 10.0.4.0/24"). Empty: none
// with ttl=0 in `url`, where other hosts cannot belong to the run, and any otherwise. Throws InvalidArgument
// that states the permitted values.
AcceptedHosts accepted_hosts(const std::string& text, const std::string& url);

// Returns the filter for a socket of LCM's udpm. It passes well-formed datagrams of accepted hosts; of the
// short messages only those whose channel matches one of `expressions` (the subscriptions of a Bus), and
// repairs of these channels. Every channel passes if an expression is neither a channel nor a prefix, or if
// there are too many.
FilterProgram receive_program(const std::multiset<std::string>& expressions, const AcceptedHosts& hosts = {});

// Returns the socket on which `lcm`, opened with `url`, receives; -1 if it is not found, not udpm, or one of
// several on its port.
int receive_socket(lcm::LCM& lcm, const std::string& url);

class ReceiveFilter {
 public:
  // Attaches to `lcm`, opened with `url`, which must outlive this object. Only Buses may subscribe to `lcm`,
  // and follow() must know their subscriptions. LCM begins to receive. If several sockets are on its port,
  // every channel passes. If no socket is found, or the kernel accepts no filter, the process warns once.
  ReceiveFilter(lcm::LCM& lcm, const std::string& url, AcceptedHosts hosts = {});
  // Passes the channels that any of the two subscribes to; null: none. Cheap if nothing has changed.
  void follow(const Subscriptions* first, const Subscriptions* second);

 private:
  void attach(const std::multiset<std::string>& expressions);

  AcceptedHosts hosts_;
  int socket_ = -1;
  // For each of the two: changes() + 1 when the filter was attached; 0: null.
  std::array<std::uint64_t, 2> changes_ = {};
};

}  // namespace halocline::bus
