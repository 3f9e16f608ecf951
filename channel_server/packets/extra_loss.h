// SPDX-License-Identifier: BSD-3-Clause
// Packets lost on purpose, to test protocols: a stated share of those that would have been received, by pair
// of vehicles, kind and span of time. Nothing else changes: such a packet still sounds, collides and is
// followed as if it had been received.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "channel_server/packets/packet.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

// A rule: the packets that it concerns, and the share of them that is dropped.
struct ExtraLoss {
  std::string from = {}, to = {};       // names of sender and receiver; empty: any
  std::optional<PacketKind> kind = {};  // empty: any
  double share = 0;                     // share of the packets that would have been received, 0..1
  SimTime begin = {};                   // first departure concerned
  SimTime end = SimTime::never();       // departures before this instant are concerned

  // True when the rule concerns a packet at the receiver of that name.
  bool concerns(const Packet& packet, const std::string& receiver) const;
};

// True when one of the rules drops the packet at a receiver. The probability is 1 - product (1 - share) over
// the rules that concern the packet, and its draw is independent of all others.
bool is_lost_on_purpose(const std::vector<ExtraLoss>& rules, std::uint64_t seed, const Packet& packet,
                        const std::string& receiver, VehicleId receiver_id);

}  // namespace halocline::channel_server
