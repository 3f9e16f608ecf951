// The outcome of one packet at one receiver from signal, noise and interference over time, for a packet above the
// cut-off, in band, with an open path, at a receiver that does not transmit.
//
// Model. The first part of a packet is its preamble, the rest holds its information bits evenly. At every
// instant SINR = S / (N + I) in the packet's band:
//   S  the paths within the guard time after the first significant one, powers added;
//   N  the noise over the band, less the receiver's directivity;
//   I  everything else that sounds: the packet's own later and earlier echoes, all paths of all other packets,
//      each during its own interval.
//   acquired  when draw 1 < acquisition_probability(modem, S / (N + mean of I over the preamble)): a correlator
//             gathers the interference of the whole preamble;
//   received  when draw 2 < exp(sum over stretches of constant I of (bits in it) ln(1 - ber(SINR))): errors of
//             bits do not depend on each other.
// Both curves are those of acoustics/modem/modem.h. Interference counts as noise that is white over the band.
//
// A loss counts as a collision when the same draws without the other packets give a reception.
//
// Draws are addressed by the packet's contents and the receiver, never by turn and not by the sender's session,
// which differs between runs of separate processes.
#pragma once

#include <cstdint>
#include <vector>

#include "channel_server/packets/packet.h"
#include "channel_server/packets/receiver_state.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::channel_server {

// Other packets weaker than this below the noise (mean over the reception) are not named as colliders: 20 dB
// below, one takes 0.04 dB off the ratio.
inline constexpr Decibels kNegligibleBelowNoise{20};
inline constexpr std::size_t kMaxColliders = 16;

// A packet as one receiver gets it; powers in uPa^2 over the packet's band.
struct ReceivedSignal {
  PacketPointer packet;
  double signal = 0, noise = 0;
  SimTime begin, preamble_end, end;
  std::vector<Interference> echoes;  // its own, outside the guard time
};

struct PacketDraws {
  double acquisition, success;  // in (0, 1)
};
PacketDraws draws_of(std::uint64_t seed, const Packet& packet, VehicleId receiver);

// Mean over [begin, end) of the sum of powers; of no duration, the sum at that instant.
double mean_power(const std::vector<Interference>& paths, SimTime begin, SimTime end);

// `disturbances` in any order.
double acquisition_probability(const ReceivedSignal& signal, const std::vector<Interference>& disturbances);
// Of all information bits being right.
double success_probability(const ReceivedSignal& signal, const std::vector<Interference>& disturbances);

// Loudest first, then by name; kMaxColliders at most.
std::vector<PacketName> colliders_of(const ReceivedSignal& signal, const Interferers& others);

// At the end of the preamble: sets the probability, and returns whether the packet is acquired.
bool acquires(const ReceivedSignal& signal, const Interferers& others, const PacketDraws& draws,
              DecisionStatistics& statistics);
// At the last bit: sets the rest. kReceived, kCollided, kNotAcquired or kBitErrors.
OutcomeKind decide_reception(const ReceivedSignal& signal, const Interferers& others,
                             const PacketDraws& draws, bool acquired, DecisionStatistics& statistics);

}  // namespace halocline::channel_server
