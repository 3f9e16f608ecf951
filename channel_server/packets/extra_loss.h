// SPDX-License-Identifier: BSD-3-Clause
// Packets lost on purpose, to test protocols: a stated share of those that would have been received, by pair,
// kind and span of time. Nothing else changes: such a packet sounds, collides and is followed as if it had
// been received.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "channel_server/packets/packet.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

struct ExtraLoss {
  std::string from = {}, to = {};       // names of sender and receiver; empty: any
  std::optional<PacketKind> kind = {};  // empty: any
  double share = 0;                     // of the packets that would have been received, 0..1
  SimTime begin = {};                   // departures from here on
  SimTime end = SimTime::never();       // and before this

  bool concerns(const Packet& packet, const std::string& receiver) const;
};

// Whether one of the rules takes the packet at a receiver: with probability 1 - product (1 - share) over
// those that concern it, by a draw that depends on nothing else.
bool is_lost_on_purpose(const std::vector<ExtraLoss>& rules, std::uint64_t seed, const Packet& packet,
                        const std::string& receiver, VehicleId receiver_id);

}  // namespace halocline::channel_server
