// SPDX-License-Identifier: BSD-3-Clause
// The outcome of one packet at one receiver from signal, noise and interference over time, for a packet above
// the cut-off, in band, with an open path, at a receiver that does not transmit.
//
// Model. The first part of a packet is its preamble, the rest holds its information bits evenly. At every
// instant and frequency SINR = S / (N + I) in the packet's band:
//   S, and the packet's own echoes in I, from the history of the signal
//   (acoustics/reception/signal_history.h): the
//      power within the guard window, which fades;
//   N  the noise over the band, less the receiver's directivity;
//   I  besides its echoes all paths of all other packets, each during its own interval, with the large-scale
//      fading of its link; the noise of other vehicles (vehicle_sounds.h), and bursts of the sea's
//      (acoustics/noise/noise_variation.h).
//   acquired  when draw 1 < acquisition_probability(modem, mean S / (N + mean I)), means over the preamble: a
//             correlator gathers what sounds during the whole of it;
//   header    right when draw 2 < P_header, 1 without one
//   frames    the first is right when draw 2 < P_header P_0, frame i when the header is and draw 2 + i < P_i;
//             P of a block is its probability to be right (acoustics/reception/decoding.h) in its own span of
//             time
//   received  when at least one frame is right.
// Given the header, draw 2 / P_header is uniform again, so all frames are decided independently of each
// other, and a packet of one frame by one draw.
// Both curves are those of acoustics/modem/modem.h. Interference counts as noise that is white over the band.
//
// A loss counts as a collision when the same draws without the other packets give a reception, and as the
// Doppler shift's when they do without the shift that the receiver does not correct.
//
// Draws are addressed by the packet's contents and the receiver, never by turn and not by the sender's
// session, which differs between runs of separate processes.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "acoustics/noise/noise_variation.h"
#include "acoustics/reception/signal_history.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/receiver_state.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/random.h"
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
  double noise = 0;
  SimTime begin, preamble_end, end;  // of the guard window's first path
  bool fades = false;
  std::vector<Interference> bursts;  // of the ambient noise, beyond `noise`; `source` is not used
  acoustics::SignalHistory history;
  // As if the receiver corrected every Doppler shift; only where it does not.
  std::optional<acoustics::SignalHistory> without_shift = {};
};

// Of a draw for a packet at a receiver: by the packet's contents, but for its session.
DrawAddress draw_address(std::uint64_t seed, std::uint32_t purpose, const Packet& packet, VehicleId receiver);

struct PacketDraws {
  double acquisition = 0, success = 0;    // in (0, 1)
  std::vector<double> later_frames = {};  // in (0, 1), of the second frame and those after it
};
// The same for all receivers of a packet.
std::uint64_t identity_for_draws(const Packet& packet);
// `identity`: identity_for_draws() of the packet.
PacketDraws draws_of(std::uint64_t seed, const Packet& packet, std::uint64_t identity, VehicleId receiver);
// Standard normal, for the measured time of arrival.
double timing_draw_of(std::uint64_t seed, std::uint64_t identity, VehicleId receiver);

// Mean over [begin, end) of the sum of powers; of no duration, the sum at that instant.
double mean_power(const std::vector<Interference>& paths, SimTime begin, SimTime end);

// Sums over `others` are taken in their order.
double acquisition_probability(const ReceivedSignal& signal, const std::vector<Interference>& others);
// Of at least one frame being right: P_header (1 - product over frames of (1 - P_i)).
double success_probability(const ReceivedSignal& signal, const std::vector<Interference>& others);

// Of the measured time of arrival: normal, with the deviation that noise leaves a matched filter,
//   sigma = 1 / (2 pi (B / sqrt(12)) sqrt(2 E/N)),  E/N = T B SINR over the preamble (over all of it without
//                                                   one)
// (Kay, Fundamentals of Statistical Signal Processing: Estimation Theory, 1993, section 3.11). 0 without
// fading.
double timing_error_s(const ReceivedSignal& signal, const Interferers& others, double standard_normal);

// Adds the bursts of the sea's noise at the receiver that fall into the packet, each g A over its part of it,
// with g above `noise` by the stated level. Bursts are counted from time 0.
void add_bursts(const acoustics::NoiseVariation& variation, std::uint64_t seed, VehicleId receiver,
                ReceivedSignal& signal);

// Loudest first, then by name; kMaxColliders at most.
std::vector<PacketName> colliders_of(const ReceivedSignal& signal, const Interferers& others);

// At the end of the preamble: sets the probability, and returns whether the packet is acquired.
bool acquires(const ReceivedSignal& signal, const Interferers& others, const PacketDraws& draws,
              DecisionStatistics& statistics);
// The header's last bit, and whether it is right by then: the same decision as at the last bit.
SimTime header_end(const ReceivedSignal& signal);
bool is_header_right(const ReceivedSignal& signal, const Interferers& others, const PacketDraws& draws);
// At the last bit: sets the rest. kReceived, kCollided, kNotAcquired or kBitErrors.
OutcomeKind decide_reception(const ReceivedSignal& signal, const Interferers& others,
                             const PacketDraws& draws, bool acquired, DecisionStatistics& statistics);

}  // namespace halocline::channel_server
