// SPDX-License-Identifier: BSD-3-Clause
// The record of a flight at its end, and the outcomes that are decided without noise and other sounds.
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

// Returns the arrival of an acquired packet's first bit, by the receiver's clock and as its modem measures
// it.
SimTime measured_arrival(const Flight& flight, const VehicleClocks& clocks);

// Returns the outcome that is decided without noise and other sounds; kReceived when the packet may be
// acquired.
OutcomeKind outcome_before_acquisition(const Flight& flight);
// True when the Doppler shift exceeds the modem's tolerance. This is a hard limit for links without fading
// only; with fading the shift reduces the signal instead (acoustics/reception/signal_history.h).
bool is_shifted_too_far(const Flight& flight);

// Evaluates the signal of `first` and, in parallel, those of the flights in `soon`, which are in their
// preambles. The signals of `soon` will be needed unless their receivers acquire other packets before. The
// work is shared out by `for_each`.
void evaluate_signals(Flight& first, std::vector<Flight*> soon, const acoustics::FadingModel& fading,
                      std::uint64_t seed, const ForEach& for_each);

// Decides the outcome at the instant `at` of the last bit and sets the remaining statistics. `receiver` holds
// the sounds at the receiver.
OutcomeKind decide_outcome(Flight& flight, SimTime at, const VehicleRegistry& fleet,
                           const ReceiverState& receiver);

// Returns the record of a flight that ended as `kind`. A `promiscuous` receiver also takes packets for
// others.
PacketOutcome outcome_of(const Flight& flight, OutcomeKind kind, const VehicleEquipment& equipment,
                         bool promiscuous = false);
// Returns the outcome kOutOfReach of a packet at a receiver `range_m` away, or with receiver_id 0 at several
// receivers. Levels are kSilence; nothing else was computed.
PacketOutcome outcome_out_of_reach(const PacketPointer& packet, double range_m, VehicleId receiver_id = 0,
                                   std::string receiver = {});
// Add the energy that a packet took from the battery of its sender, and of its receiver by the packet's end.
// Nothing is added for a vehicle without a battery.
void add_sending(const Packet& packet, const VehiclePower& power, std::vector<MediumEvent>& events);
void add_receiving(const Flight& flight, const PacketOutcome& outcome, SimTime at, const VehiclePower& power,
                   std::vector<MediumEvent>& events);
// True when the receiver's modem answers without its user's program: its addressee received a ping or a
// packet that asks for an acknowledgement, or a transponder received a ping to all.
bool asks_for_answer(const PacketOutcome& outcome, const VehicleEquipment& equipment);
// Returns the answer to a packet that was received by `at`. It leaves one turnaround time after the packet's
// last bit, by the receiver's clock.
ModemReply answer_of(const Flight& flight, SimTime at, const VehicleClocks& clocks);

}  // namespace halocline::channel_server
