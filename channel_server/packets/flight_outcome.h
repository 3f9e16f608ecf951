// SPDX-License-Identifier: BSD-3-Clause
// The record of a flight at its end, and what decides it before noise and other sounds do.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "acoustics/fading/path_fading.h"
#include "channel_server/packets/flight.h"
#include "channel_server/packets/medium_event.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/receiver_state.h"
#include "channel_server/vehicles/vehicle_clocks.h"
#include "channel_server/vehicles/vehicle_equipment.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_power.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/for_each.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

// The first bit's arrival of a packet that was acquired, by the receiver's clock, as its modem measures it.
SimTime measured_arrival(const Flight& flight, const VehicleClocks& clocks);

// Without regard to noise and other sounds; kReceived: the packet may be acquired.
OutcomeKind outcome_before_acquisition(const Flight& flight);
// A wall where nothing fades; with fading the shift costs signal (acoustics/reception/signal_history.h).
bool is_shifted_too_far(const Flight& flight);

// Evaluates the signal of `first`, and beside it those of `soon`, flights in their preambles, that will be
// asked for unless their receivers acquire others before; shared out by `for_each`.
void evaluate_signals(Flight& first, std::vector<Flight*> soon, const acoustics::FadingModel& fading,
                      std::uint64_t seed, const ForEach& for_each);

// At the last bit, at `at`: sets the rest of the statistics. `receiver`: what sounds there meanwhile.
OutcomeKind decide_outcome(Flight& flight, SimTime at, const VehicleRegistry& fleet,
                           const ReceiverState& receiver);

// The record of a flight that ended as `kind`; `promiscuous`: the receiver takes packets for others, too.
PacketOutcome outcome_of(const Flight& flight, OutcomeKind kind, const VehicleEquipment& equipment,
                         bool promiscuous = false);
// Of a packet that does not get as far as `range_m`, at a receiver, or without one at several: kOutOfReach.
// Levels are kSilence, nothing else was computed.
PacketOutcome outcome_out_of_reach(const PacketPointer& packet, double range_m, VehicleId receiver_id = 0,
                                   std::string receiver = {});
// What a packet took from the battery of its sender, and of its receiver by its end; nothing without one.
void add_sending(const Packet& packet, const VehiclePower& power, std::vector<MediumEvent>& events);
void add_receiving(const Flight& flight, const PacketOutcome& outcome, SimTime at, const VehiclePower& power,
                   std::vector<MediumEvent>& events);
// Whether the receiver's modem answers by itself: a ping, or a packet that wants an acknowledgement, received
// by its addressee; a ping to all received by a transponder.
bool asks_for_answer(const PacketOutcome& outcome, const VehicleEquipment& equipment);
// The answer to a packet that was received by `at`: it leaves a turnaround later by the receiver's clock.
ModemReply answer_of(const Flight& flight, SimTime at, const VehicleClocks& clocks);

}  // namespace halocline::channel_server
