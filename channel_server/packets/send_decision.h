// SPDX-License-Identifier: BSD-3-Clause
// The decision about a request to transmit at its start, and the packet of a queued request at its departure.
#pragma once

#include "channel_server/packets/packet.h"
#include "channel_server/packets/packet_framing.h"
#include "channel_server/packets/send_register.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

inline constexpr std::size_t kMaxQueuedSends = 16;  // queued packets at one modem

// The result of a request to transmit.
struct SendDecision {
  SendResult result;
  SimTime start;  // start of the transmission when it is accepted or queued
};

// Decides about a request that is sent with `framing`.
SendDecision decide_send(const SendRequest& request, const Framing& framing, const VehicleRegistry& fleet,
                         const SendRegister& sends);

// Returns a queued packet as it departs, with the sender's position then. When the sender has been forgotten
// since, the packet keeps the position at which it was accepted.
PacketPointer at_its_departure(const Packet& queued, const VehicleRegistry& fleet);

}  // namespace halocline::channel_server
