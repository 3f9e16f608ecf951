// SPDX-License-Identifier: BSD-3-Clause
// One packet on its way to one receiver: when and how its sound arrives where the receiver is by then.
//
// Model. The first significant path arrives at the t that solves
//     t = s + delay(sender at s, receiver at t).
// The propagation is evaluated where the receiver is predicted to be after the straight line's travel time;
// from there the delay to a position nearby is taken to first order, delay + (direction of arrival / sound
// speed) . (displacement), and t found by fixed point (a contraction: the error falls by v/c, 1e-3 for a
// submarine, each round). When the sound is about to arrive more than 0.1 m from there, the propagation is
// evaluated again where it will meet the receiver, so that second-order terms (displacement^2 / (2 range c))
// are those of the 0.1 m within which a reception is reused: below a nanosecond beyond 2 km.
//
// Evaluations of the propagation: one for a receiver at rest or on a straight course, three at most for
// one that turns. All paths of a flight hold for the one place of its first significant path.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "acoustics/fading/path_fading.h"
#include "acoustics/modem/modem.h"
#include "acoustics/reception/guard_window.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/receiver_state.h"
#include "channel_server/packets/reception_decision.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/reach.h"
#include "channel_server/vehicles/state_history.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/for_each.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

struct Flight {
  // kSolved: the sound is there, what vehicles sound like is not known yet.
  enum class Stage { kTravelling, kSolved, kPreamble, kBits };

  PacketPointer packet;
  std::uint64_t identity = 0;  // of the packet, for draws
  VehicleId receiver_id = 0;
  std::string receiver;
  Stage stage = Stage::kTravelling;

  // Of the latest solution.
  acoustics::Modem modem;  // the receiver's
  Placement place;         // the receiver's that `reception` holds for
  Reception reception;
  acoustics::GuardWindow window;  // where the receiver locks; of no path, empty
  double solved_delay_s = 0;  // of the first significant path at `place`; of the straight line without one
  Vec3 slowness_s_per_m = Vec3::Zero();  // of that path where it arrives
  int propagation_calls = 0, solutions = 0;
  double travel_time_s = 0;  // of the first significant path

  // Once it has arrived.
  ReceiverState* sounds_at = nullptr;  // which it is open at until it ends
  bool is_too_late = false;            // it overlaps a reception that was decided before it was known
  bool receiver_absent = false;        // at the first significant path: its state is older than the time-out
  std::vector<NoiseSound> noise;       // of other vehicles, during the packet
  double large_scale = 1;              // of the pressures, by the link's large-scale fading
  ReceivedSignal signal;
  bool is_evaluated = false;  // the signal, by evaluate_signal()
  PacketDraws draws = {};
  std::shared_ptr<const Packet> followed;  // another packet, which the receiver has acquired before
  bool acquired = false;
  bool reports = false;       // its detection was reported, so its end is
  double timing_error_s = 0;  // of the arrival, as the receiver measures it; 0 unless acquired
  DecisionStatistics statistics;

  SimTime arrival() const { return packet->departure + SimDuration::from_seconds(travel_time_s); }
  // Of the first path of all.
  SimTime first_sound() const;
  // When the path that the guard window begins at begins.
  SimTime lock() const;
  // Of the strongest path in the guard window; 1 without a path.
  double doppler_factor() const;
};

// Gives flights of one packet, none of which was solved yet, the reception that try_to_solve() would ask for,
// where the propagation is ready for it; that is shared out by `for_each`.
void evaluate_together(const std::vector<Flight*>& begun, const VehicleRegistry& fleet,
                       Propagation& propagation, const ForEach& for_each);

// Solves for travel time and reception, with what is known at `decided_at`; false, and nothing is changed,
// where the propagation does not know all that it needs (Propagation::is_ready_for_packet). A receiver that
// is forgotten keeps the last solution. Throws as Propagation::reception.
[[nodiscard]] bool try_to_solve(Flight& flight, SimTime decided_at, const VehicleRegistry& fleet,
                                Propagation& propagation);

// All paths of a flight that has arrived, as the receiver gets them, with the link's large-scale fading.
AudiblePacket audible_packet(const Flight& flight);
// The same, without paths where they are too weak to disturb; such a packet may be acquired all the same.
// Without `reach` all disturb.
AudiblePacket disturbing_sound(const Flight& flight, const ReachModel* reach);
// The packet's times at the receiver; `noise` in uPa^2 over the packet's band, less the receiver's
// directivity.
ReceivedSignal received_signal(const Flight& flight, double noise, const acoustics::FadingModel& fading);
// Sets signal and echoes over those times, as they have been known since the signal began. Of no path: they
// stay empty. Calls for different flights may overlap between threads.
void evaluate_signal(Flight& flight, const acoustics::FadingModel& fading, std::uint64_t seed);
// 10^(X/20) of the flight's link when it locks.
double large_scale_of(const Flight& flight, const acoustics::FadingModel& fading, std::uint64_t seed);

}  // namespace halocline::channel_server
