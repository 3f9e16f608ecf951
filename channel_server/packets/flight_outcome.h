// The record of a flight at its end, and what decides it before noise and other sounds do.
#pragma once

#include "channel_server/packets/flight.h"
#include "channel_server/packets/packet.h"
#include "channel_server/vehicles/vehicle_clocks.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

// Without regard to noise and other sounds; kReceived: the packet may be acquired.
OutcomeKind outcome_before_acquisition(const Flight& flight);
// A wall where nothing fades; with fading the shift costs signal (acoustics/reception/signal_history.h).
bool is_shifted_too_far(const Flight& flight);

// The record of a flight that ended as `kind`.
PacketOutcome outcome_of(const Flight& flight, OutcomeKind kind, const VehicleClocks& clocks);
// Of a packet that does not get as far as `range_m`, at several receivers: kOutOfReach. Levels are kSilence, nothing else was
// computed.
PacketOutcome outcome_out_of_reach(const PacketPointer& packet, double range_m);
// Of a ping that was received by `at`: its addressee's modem answers, a turnaround later by its clock.
PingAnswer answer_of(const Flight& flight, SimTime at, const VehicleClocks& clocks);

}  // namespace halocline::channel_server
