// SPDX-License-Identifier: BSD-3-Clause
// The propagation of one packet to one receiver that may move: when and how its sound arrives at the position
// that the receiver has reached by then.
//
// Model. The packet departs at s. Its first significant path arrives at the instant t that solves
//     t = s + delay(sender at s, receiver at t).
// The propagation is evaluated at the receiver's predicted position after the travel time along the straight
// line. From there the delay to a nearby position x is linearised,
//     delay(x) = delay(x0) + p . (x - x0),   p: slowness vector of the arriving ray, 1 / sound speed long,
// and t is found by fixed-point iteration. The iteration is a contraction: each round reduces the error by
// v/c, 1e-3 for an AUV. When the sound is about to arrive and the receiver will be more than 0.1 m from x0,
// the propagation is evaluated again at the predicted point of arrival. The neglected second-order terms,
// displacement^2 / (2 range c), are therefore those of at most 0.1 m: below a nanosecond beyond 2 km.
//
// The propagation is evaluated once for a receiver at rest or on a straight course, and at most three times
// for one that turns. All paths of a flight are computed for the receiver's position at the arrival of the
// first significant path.
#pragma once

#include <cstdint>
#include <memory>
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

// The state of a packet on its way to one receiver: the latest solution for its arrival, and from the arrival
// on its reception.
struct Flight {
  // The stage of a flight: kTravelling before its first sound, kSolved when the sound has arrived but the
  // noise of vehicles at the receiver is not known yet, kPreamble until the end of the preamble, kBits until
  // the last bit.
  enum class Stage { kTravelling, kSolved, kPreamble, kBits };

  PacketPointer packet;
  std::uint64_t identity = 0;  // identity_for_draws() of the packet
  VehicleId receiver_id = 0;
  std::string receiver;
  Stage stage = Stage::kTravelling;

  // Results of the latest solution.
  acoustics::Modem modem;  // the receiver's
  Placement place;         // the receiver's position and velocity for which `reception` was computed
  Reception reception;
  acoustics::GuardWindow window;  // the guard window on which the receiver synchronises; empty without a path
  // Delay of the first significant path at `place`; of the straight line without a path.
  double solved_delay_s = 0;
  Vec3 slowness_s_per_m = Vec3::Zero();  // slowness vector of that path at `place`
  int propagation_calls = 0, solutions = 0;
  double travel_time_s = 0;  // along the first significant path

  // Set from the arrival on.
  ReceiverState* sounds_at = nullptr;  // the receiver at which this reception is open; null before
  bool conflicts_with_past =
      false;                      // the packet overlaps a reception that was decided before its request came
  bool out_of_water = false;      // the waves leave the sender or the receiver out of the water
  bool receiver_absent = false;   // the receiver's last state had timed out at the first significant path
  std::vector<NoiseSound> noise;  // noise of other vehicles, constant during the packet
  double large_scale = 1;         // factor on pressures by the link's large-scale fading
  ReceivedSignal signal;
  bool is_evaluated = false;  // true once evaluate_signal() has set `signal`
  PacketDraws draws = {};
  // The packet that the receiver is following instead; null without one.
  std::shared_ptr<const Packet> followed;
  bool acquired = false;
  bool reports = false;       // the detection was reported, so the end is reported, too
  double timing_error_s = 0;  // error of the measured arrival; 0 unless acquired
  DecisionStatistics statistics;

  // Returns when the first significant path begins to sound.
  SimTime arrival() const { return packet->departure + SimDuration::from_seconds(travel_time_s); }
  // Returns when the earliest path begins to sound.
  SimTime first_sound() const;
  // Returns when the first path of the guard window begins to sound: the receiver synchronises on it.
  SimTime sync_time() const;
  // Returns the Doppler factor of the strongest path in the guard window; 1 without a path.
  double doppler_factor() const;
};

// Computes the receptions that try_to_solve() would ask for, for flights of one packet of which none is
// solved yet, and only where the propagation is ready. The work is shared out by `for_each`.
void evaluate_together(const std::vector<Flight*>& begun, const VehicleRegistry& fleet,
                       Propagation& propagation, const ForEach& for_each);

// Solves for travel time and reception, with what is known at `decided_at`. Returns false and changes nothing
// when the propagation does not know all that it needs (Propagation::is_ready_for_packet). For a receiver
// that has been forgotten the last solution stays. Throws as Propagation::reception does.
[[nodiscard]] bool try_to_solve(Flight& flight, SimTime decided_at, const VehicleRegistry& fleet,
                                Propagation& propagation);

// Returns the paths of an arrived flight as they sound at the receiver, with the link's large-scale fading.
AudiblePacket audible_packet(const Flight& flight);
// Returns audible_packet(), without its paths when they are too weak to disturb other receptions; such a
// packet may still be acquired. Without `reach` every packet disturbs, except that of a sender out of the
// water.
AudiblePacket disturbing_sound(const Flight& flight, const ReachModel* reach);
// Returns the times of the packet at the receiver, without the history of its signal. `noise` is in uPa^2
// over the packet's band, less the receiver's directivity.
ReceivedSignal received_signal(const Flight& flight, double noise, const acoustics::FadingModel& fading);
// Sets the history of signal and echoes between those times, with the fading since the signal began. It stays
// empty without a path. Calls for different flights may run in parallel.
void evaluate_signal(Flight& flight, const acoustics::FadingModel& fading, std::uint64_t seed);
// Returns the large-scale fading factor on pressures, 10^(X/20) with X in dB, of the flight's link at lock().
double large_scale_of(const Flight& flight, const acoustics::FadingModel& fading, std::uint64_t seed);

}  // namespace halocline::channel_server
