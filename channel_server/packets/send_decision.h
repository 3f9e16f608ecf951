// SPDX-License-Identifier: BSD-3-Clause
// What becomes of a request to transmit at its start, and the packet that it makes.
#pragma once

#include "channel_server/packets/packet.h"
#include "channel_server/packets/packet_framing.h"
#include "channel_server/packets/send_register.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

inline constexpr std::size_t kMaxQueuedSends = 16;  // at one modem

struct SendDecision {
  SendResult result;
  SimTime start;  // of the transmission, where it is accepted or queued
};

// Of a request that is sent as `framing`.
SendDecision decide_send(const SendRequest& request, const Framing& framing, const VehicleRegistry& fleet,
                         const SendRegister& sends);

// A queued packet as it departs: where the sender is by then, or was when the packet was accepted should it
// be forgotten since.
PacketPointer at_its_departure(const Packet& queued, const VehicleRegistry& fleet);

}  // namespace halocline::channel_server
