// SPDX-License-Identifier: BSD-3-Clause
// The outcome of one packet at one receiver, decided from signal, noise and interference over time. It
// applies to packets above the cut-off level and in band, with an open path, at a receiver that does not
// transmit.
//
// Model. A packet begins with its preamble; its information bits fill the rest evenly. At every instant and
// frequency the signal-to-interference-and-noise ratio in the packet's band is
//     SINR = n S / (N 10^(loss / 10) + I)
//   S  the power within the guard window, which fades; it comes from the history of the signal
//      (acoustics/reception/signal_history.h), as do the packet's own echoes in I;
//   n, loss  hydrophones and loss of the receiver (acoustics/modem/modem.h);
//   N  the noise over the band, less the receiver's directivity;
//   I  the packet's own echoes; all paths of all other packets, each during its own interval, with the
//      large-scale fading of its link; the noise of other vehicles (platform_noise.h); and bursts of the
//      sea's noise (acoustics/noise/noise_variation.h). It counts as noise that is white over the band.
// A packet has these random draws, uniform in (0, 1): d1 for acquisition, d2 for the header and frame 0,
// d(2+i) for frame i.
//   acquired  when d1 < acquisition_probability(modem, mean S / (N + mean I)); means over the preamble,
//             because a correlator gathers what sounds during the whole of it;
//   header    right when d2 < P_header; P_header is 1 without a header;
//   frames    frame 0 is right when d2 < P_header P_0; frame i is right when the header is and d(2+i) < P_i.
//             P of a block is its probability to be right (acoustics/reception/decoding.h) in its own span
//             of time;
//   received  when at least one frame is right.
// Given the header, d2 / P_header is uniform again. All frames are therefore decided independently of each
// other, and a packet of one frame is decided by one draw. Both curves, of acquisition and of bit errors, are
// those of acoustics/modem/modem.h.
//
// A loss counts as a collision when the same draws without the other packets give a reception. It counts as
// caused by the Doppler shift when the same draws without the uncorrected part of the shift give a reception.
//
// The reason of a loss is the one of five powers (noise, late echoes, fast fading with Doppler, other
// packets, impulses) without which acquisition and decoding would be likeliest, by the same curves.
//
// A draw depends only on the packet's contents and the receiver: not on the order of draws, and not on the
// sender's session, which differs between runs of separate processes.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "acoustics/noise/noise_variation.h"
#include "acoustics/reception/disturbing_powers.h"
#include "acoustics/reception/signal_history.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/receiver_state.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/random.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::channel_server {

// Other packets whose mean power over the reception is this far below the noise are not named as colliders:
// 20 dB below the noise, a packet lowers the SINR by 0.04 dB.
inline constexpr Decibels kNegligibleBelowNoise{20};
inline constexpr std::size_t kMaxColliders = 16;

// A packet as one receiver gets it; powers in uPa^2 over the packet's band.
struct ReceivedSignal {
  PacketPointer packet;
  double noise = 0;
  SimTime begin, preamble_end, end;  // times of the guard window's first path
  bool fades = false;
  std::vector<Interference> bursts;  // bursts of the ambient noise, added to `noise`; `source` is not used
  acoustics::SignalHistory history;
  // The history if the receiver corrected every Doppler shift; empty when it does.
  std::optional<acoustics::SignalHistory> without_shift = {};
  double impulses = 0;  // power that impulsive noise is worth beyond `noise`, before the receiver's loss
};

// Returns the address of a draw for a packet at a receiver: it depends on the packet's contents except its
// session.
DrawAddress draw_address(std::uint64_t seed, std::uint32_t purpose, const Packet& packet, VehicleId receiver);

// The uniform random draws that decide a packet at one receiver: d1, d2 and d(2+i) of the model.
struct PacketDraws {
  double acquisition = 0, success = 0;    // in (0, 1)
  std::vector<double> later_frames = {};  // in (0, 1), for the second frame and those after it
};
// Returns a hash of the packet's contents, the same for all its receivers.
std::uint64_t identity_for_draws(const Packet& packet);
// Returns the draws of a packet at a receiver. `identity` is identity_for_draws() of the packet.
PacketDraws draws_of(std::uint64_t seed, const Packet& packet, std::uint64_t identity, VehicleId receiver);
// Returns the standard normal draw of the error of the measured time of arrival.
double timing_draw_of(std::uint64_t seed, std::uint64_t identity, VehicleId receiver);

// Returns the mean over [begin, end) of the sum of powers, uPa^2; the sum at `begin` when the span is empty.
double mean_power(const std::vector<Interference>& paths, SimTime begin, SimTime end);

// Returns the probability that the preamble is acquired. Sums over `others` are taken in their order, so that
// rounding does not depend on the order of arrival.
double acquisition_probability(const ReceivedSignal& signal, const std::vector<Interference>& others);
// Returns the probability that at least one frame is right: P_header (1 - product over frames of (1 - P_i)).
double success_probability(const ReceivedSignal& signal, const std::vector<Interference>& others);

// Returns the error of the measured time of arrival, s. It is normal, with the standard deviation that noise
// leaves a matched filter,
//   sigma = 1 / (2 pi (B / sqrt(12)) sqrt(2 E/N)),   E/N = T B SINR
// over the preamble, or over the whole packet without a preamble (Kay, Fundamentals of Statistical Signal
// Processing: Estimation Theory, 1993, section 3.11). Returns 0 without fading.
double timing_error_s(const ReceivedSignal& signal, const Interferers& others, double standard_normal);

// Adds the bursts of the sea's noise at the receiver that fall into the packet. A burst has the power g A
// during its interval: g exceeds `noise` by the stated level, A is the burst's random power. The bursts' grid
// begins at time 0. Nothing is added where bursts are a part of the noise's level.
void add_bursts(const acoustics::NoiseVariation& variation, std::uint64_t seed, VehicleId receiver,
                ReceivedSignal& signal);

// Returns the power without which acquisition and decoding of a lost packet would be likeliest; the greatest
// where none makes a difference alone, kNone where nothing disturbs. `powers` are those of the packet.
acoustics::LossReason loss_reason(const ReceivedSignal& signal, const std::vector<Interference>& others,
                                  const acoustics::DisturbingPowers& powers);

// Returns the names of the packets that disturbed the reception, loudest first, then by name; at most
// kMaxColliders.
std::vector<PacketName> colliders_of(const ReceivedSignal& signal, const Interferers& others);

// Sets the probability of acquisition at the end of the preamble, and returns true when the packet is
// acquired.
bool acquires(const ReceivedSignal& signal, const Interferers& others, const PacketDraws& draws,
              DecisionStatistics& statistics);
// Return the instant of the header's last bit, and whether the header is right by then. decide_reception()
// decides the same about the header at the packet's last bit.
SimTime header_end(const ReceivedSignal& signal);
bool is_header_right(const ReceivedSignal& signal, const Interferers& others, const PacketDraws& draws);
// Decides at the last bit and sets the remaining statistics. Returns kReceived, kCollided, kDoppler,
// kNotAcquired or kBitErrors.
OutcomeKind decide_reception(const ReceivedSignal& signal, const Interferers& others,
                             const PacketDraws& draws, bool acquired, DecisionStatistics& statistics);

}  // namespace halocline::channel_server
