// One packet on its way to one receiver: when and how its sound comes in where the receiver is by then.
//
// Model. The first significant path arrives at the t that solves
//     t = s + delay(sender at s, receiver at t).
// The propagation is asked for the receiver's place as predicted; from there the delay to a place nearby is
// taken to first order, delay + (direction of arrival / sound speed) . (displacement), and t found by fixed
// point (a contraction: the error falls by v/c, 1e-3 for a submarine, each round). When the sound is about to
// come in, the propagation is asked again for the place where it will meet the receiver, so that second-order
// terms (displacement^2 / (2 range c)) are those of the 0.1 m within which an answer is reused: below a
// nanosecond beyond 2 km.
//
// Questions to the propagation: one for a receiver that lies still, two for one that keeps its course, three at
// most for one that turns. All paths of a flight hold for the one place of its first significant path.
#pragma once

#include <optional>
#include <string>

#include "channel_server/packets/packet_judge.h"
#include "channel_server/packets/receiver_state.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/vehicles/vehicle_registry.h"

namespace halocline::channel_server {

struct Flight {
  enum class Stage { kComing, kPreamble, kBits };

  PacketPointer packet;
  VehicleId receiver_id = 0;
  std::string receiver;
  Stage stage = Stage::kComing;

  // Of the latest solution.
  acoustics::Modem modem;  // the receiver's
  Placement place;         // the receiver's that `reception` holds for
  Reception reception;
  int times_asked = 0, times_aimed = 0;
  double travel_time_s = 0;  // of the first significant path

  // Once it has come.
  bool gone = false;  // at the first significant path
  ReceivedSignal signal;
  std::shared_ptr<const Packet> locked_onto;  // the receiver's at the end of the preamble, another packet
  bool noticed = false;
  Judgement judgement;

  SimTime arrival() const { return packet->departure + SimDuration::from_seconds(travel_time_s); }
  // Of the first path of all.
  SimTime first_sound() const;
  // Of the strongest path; 1 without a path.
  double doppler_factor() const;
};

// Finds travel time and reception, with what is known at `decided_at`. A receiver that is forgotten keeps the
// last solution. Throws as Propagation::reception.
void aim(Flight& flight, SimTime decided_at, const VehicleRegistry& fleet, Propagation& propagation);

// What the receiver hears of a flight that has come.
HeardPacket heard_packet(const Flight& flight);
// The same as signal and echoes; `noise` in uPa^2 over the packet's band, less the receiver's directivity.
ReceivedSignal received_signal(const Flight& flight, double noise);

}  // namespace halocline::channel_server
