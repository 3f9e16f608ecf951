// Leaves out datagrams of channels that nobody here subscribes to, in the kernel: they wake no thread and fill no buffer.
//
// LCM receives every datagram of its bus and then discards those that nobody wants, which costs a process two system calls each. A
// classic packet filter (McCanne and Jacobson 1993, "The BSD packet filter") on LCM's socket compares the channel where it stands in the
// datagram. Larger messages, which LCM cuts in fragments, all pass. The kernel counts what is left out in InErrors of
// /proc/net/snmp and in the drops of /proc/net/udp; what a full buffer loses is in RcvbufErrors.
#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include <lcm/lcm-cpp.hpp>
#include <linux/filter.h>

#include "bus/subscription.h"

namespace halocline::bus {

// The filter for a socket of LCM's udpm: passes datagrams whose channel one of `expressions` matches (what Bus subscribes to), repairs of
// these channels, and what is no short message of LCM. Empty where an expression is neither a channel nor a prefix, or where there are
// too many: everything has to pass.
std::vector<sock_filter> receive_program(const std::multiset<std::string>& expressions);

class ReceiveFilter {
 public:
  // For `lcm`, opened with `url`, which must outlive this; nothing may subscribe to it but Buses whose subscriptions are followed.
  // Where its socket is not found, not udpm or one of several on its port, nothing is left out.
  ReceiveFilter(lcm::LCM& lcm, const std::string& url);
  // Passes what any of them subscribes to; null: nothing. Cheap where nothing has changed.
  void follow(const Subscriptions* first, const Subscriptions* second);

 private:
  void attach(const std::multiset<std::string>& expressions);

  int socket_ = -1;
  std::array<std::uint64_t, 2> changes_ =
      {};  // of each one more than its own when the filter was attached; 0: of none
};

}  // namespace halocline::bus
