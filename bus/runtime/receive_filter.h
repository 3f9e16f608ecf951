// SPDX-License-Identifier: BSD-3-Clause
// Leaves out datagrams of channels that nobody here subscribes to, and what is no sound part of a message
// (bus/sending/datagram_filter.h), in the kernel: they wake no thread and fill no buffer.
//
// LCM receives every datagram of its bus and then discards those that nobody wants, which costs a process
// two system calls each. A classic packet filter (McCanne and Jacobson 1993, "The BSD packet filter") on
// LCM's socket compares the channel where it stands in the datagram. Larger messages, which LCM cuts in
// fragments, pass whatever their channel. The kernel counts what is left out in InErrors of /proc/net/snmp
// and in the drops of /proc/net/udp; what a full buffer loses is in RcvbufErrors.
//
// LCM binds every interface of a host, so its port takes datagrams of any host that can reach it, whatever
// the ttl. The filter also leaves out those of hosts that are not accepted. Source addresses can be forged on
// a network that lets them; this host is known by how a datagram came in, not by its address.
#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "bus/sending/datagram_filter.h"
#include "bus/subscription.h"

namespace halocline::bus {

// Hosts whose datagrams are received, beside this one.
struct AcceptedHosts {
  struct Range {
    std::uint32_t address = 0, mask = 0;  // IPv4, host byte order
  };
  bool any = true;
  std::vector<Range> ranges;  // where not any
};
// `text`: "any", or addresses and ranges of IPv4 with commas between them ("10.0.3.7, 10.0.4.0/24"); empty:
// none with ttl=0 in `url`, where other hosts cannot belong to the run, and any otherwise. Throws
// InvalidArgument that says what is allowed.
AcceptedHosts accepted_hosts(const std::string& text, const std::string& url);

// The filter for a socket of LCM's udpm: passes datagrams of accepted hosts that are sound, and of the
// short messages those whose channel one of `expressions` matches (what Bus subscribes to), and repairs of
// these channels. Where an expression is neither a channel nor a prefix, or where there are too many, every
// channel passes.
FilterProgram receive_program(const std::multiset<std::string>& expressions, const AcceptedHosts& hosts = {});

// The socket by which `lcm`, opened with `url`, receives; -1 where it is not found, not udpm or one of
// several on its port.
int receive_socket(lcm::LCM& lcm, const std::string& url);

class ReceiveFilter {
 public:
  // For `lcm`, opened with `url`, which must outlive this; nothing may subscribe to it but Buses whose
  // subscriptions are followed. LCM begins to receive. Where several sockets are on its port every channel
  // passes them. Where no socket is found, or the kernel takes no filter, the process warns once.
  ReceiveFilter(lcm::LCM& lcm, const std::string& url, AcceptedHosts hosts = {});
  // Passes what any of them subscribes to; null: nothing. Cheap where nothing has changed.
  void follow(const Subscriptions* first, const Subscriptions* second);

 private:
  void attach(const std::multiset<std::string>& expressions);

  AcceptedHosts hosts_;
  int socket_ = -1;
  std::array<std::uint64_t, 2> changes_ =
      {};  // of each one more than its own when the filter was attached; 0: of none
};

}  // namespace halocline::bus
