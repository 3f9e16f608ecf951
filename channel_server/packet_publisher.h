// SPDX-License-Identifier: BSD-3-Clause
// Publishes what happens to packets: RECEIPT, RECEIVE, OUTCOME, MODEM_EVENT, MODEM_ENERGY, and MODEM_REPLY
// for other shards. Each is published once in all incarnations of the server; what was due while it was away
// counts as late.
#pragma once

#include <cstdint>

#include "bus/bus.h"
#include "bus/runtime/crash_journal.h"
#include "channel_server/packets/medium_event.h"
#include "channel_server/packets/packet.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

class PacketPublisher {
 public:
  // Both must outlive it.
  PacketPublisher(bus::Bus& bus, bus::CrashJournal& journal) : bus_(bus), journal_(journal) {}

  void publish(const MediumEvent& event);
  void publish(const Receipt& receipt, SimTime at);
  // Outcomes that were published while recovering.
  std::int64_t published_late() const { return published_late_; }

 private:
  void publish(const PacketOutcome& outcome, SimTime at, bool late);

  bus::Bus& bus_;
  bus::CrashJournal& journal_;
  std::int64_t published_late_ = 0;
};

}  // namespace halocline::channel_server
