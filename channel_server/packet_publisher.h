// SPDX-License-Identifier: BSD-3-Clause
// The publisher of packet events: RECEIPT, RECEIVE, OUTCOME, MODEM_EVENT, MODEM_ENERGY, and MODEM_REPLY for
// other shards. Each event is published once by all incarnations of the server together. An outcome that was
// due while the server was down counts as late.
#pragma once

#include <cstdint>

#include "bus/bus.h"
#include "bus/recovery/crash_journal.h"
#include "channel_server/packets/medium_event.h"
#include "channel_server/packets/packet.h"
#include "channel_server/propagation/propagation.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

class PacketPublisher {
 public:
  // The references must outlive the publisher.
  PacketPublisher(bus::Bus& bus, bus::CrashJournal& journal) : bus_(bus), journal_(journal) {}

  void publish(const MediumEvent& event);
  void publish(const Receipt& receipt, SimTime at);
  // Returns the number of outcomes published during recovery.
  std::int64_t published_late() const { return published_late_; }

 private:
  void publish(const PacketOutcome& outcome, SimTime at, bool late);
  // Warns once a run of packets whose way leaves the known terrain.
  void warn_of_terrain(PropagationUsed used);

  bus::Bus& bus_;
  bus::CrashJournal& journal_;
  std::int64_t published_late_ = 0;
  bool warned_of_terrain_ = false;
};

}  // namespace halocline::channel_server
