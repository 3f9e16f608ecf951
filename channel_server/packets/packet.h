// SPDX-License-Identifier: BSD-3-Clause
// The inputs and outputs of the packet medium: requests to transmit, receipts, and outcomes of packets.
#pragma once

#include <compare>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "acoustics/link/link_budget.h"
#include "acoustics/modem/modem.h"
#include "acoustics/modem/packet_format.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::channel_server {

// In the order of modem_send_t.
enum class PacketKind {
  kData,
  kPing,       // to one vehicle, whose modem answers by itself; to all: transponders do (vehicle_equipment.h)
  kPingReply,  // that answer; carries session and packet_sequence of the ping
  kAck,        // the answer to a packet that wants one, likewise; the payload says which frames were right
  kMiniPacket,  // a few bits
  kJanus,       // JANUS's baseline packet, without cargo
  kJanusCargo,  // the same with cargo
};

// Whether modems make it by themselves.
constexpr bool is_answer(PacketKind kind) {
  return kind == PacketKind::kPingReply || kind == PacketKind::kAck;
}

// From the last bit of a packet as sent (counted from its first bit's arrival) to the first bit of the
// modem's answer. Our choice: time for a modem to decode and to turn from receiving to sending, and longer
// than Doppler makes any packet (10 ms of 3 s at 5 m/s); both ends know it, so that the sender of the packet
// can subtract it.
inline constexpr SimDuration kReplyTurnaround = SimDuration::from_milliseconds(100);

// Transmit this: `session` and `packet_sequence` are the sender's names for it.
struct SendRequest {
  std::string vehicle;           // by the channel of the request
  VehicleId source_id = 0;       // as stated in the request
  VehicleId destination_id = 0;  // kBroadcastId for all
  std::int64_t session = 0;      // 0 where the sender keeps none
  std::int64_t packet_sequence = 0;
  SimTime start;  // when the first bit is to leave; a modem that queues may send it later
  std::vector<std::uint8_t> payload;
  PacketKind kind = PacketKind::kData;
  bool stamped = true;     // the packet carries the instant of its departure by the sender's clock
  bool wants_ack = false;  // to one vehicle, whose modem answers by itself
  std::optional<std::int32_t> rate_number = {};  // none: the modem's own rate
  std::optional<Decibels> source_level = {};     // dB re 1 uPa at 1 m; none: the modem's own
  std::int32_t header_number = 0;                // of the sender's choice, carried by the header, 0..255
  std::vector<std::int32_t> frame_bytes = {};    // of the payload's frames; none: as the modem divides it
};

// Whether modems answer it by themselves.
inline bool wants_answer(const SendRequest& request) {
  return request.kind == PacketKind::kPing || request.wants_ack;
}

// A modem answers a packet by itself.
struct ModemReply {
  SendRequest request;  // of the answer; starts when it leaves
  SimTime asked_departure;
  SimDuration asked_duration;
};

// In the order of modem_receipt_t.
enum class SendResult {
  kAccepted,
  kBusy,            // another transmission of this modem overlaps this one
  kTooLarge,        // the payload or a frame is beyond what the modem sends in a packet of this kind
  kUnknownVehicle,  // no fresh state at the start: nowhere to transmit from
  kWrongSource,     // source_id is not the id of the vehicle
  kStale,           // the start lies too far in the past
  kTooEarly,        // the start lies too far in the future
  kQueued,          // accepted; it starts when those before it have ended
  kQueueFull,       // the modem queues, and too many wait already
  kNoRate,          // the modem has no rate of that number
  kNoKind,          // the modem has no packets of that kind, or not at that rate
  kNoModem,         // the vehicle carries none, or its battery is empty
};

struct Receipt {
  std::string vehicle;
  std::int64_t session = 0;
  std::int64_t packet_sequence = 0;
  SendResult result = SendResult::kAccepted;
  SimTime start = {};         // 0 unless accepted or queued
  SimDuration duration = {};  // 0 unless accepted or queued
};

// Tells a packet from all others in the water.
struct PacketName {
  VehicleId source_id = 0;
  std::int64_t packet_sequence = 0;
  PacketKind kind = PacketKind::kData;
  VehicleId destination_id = 0;
  SimTime departure;
  std::int64_t session = 0;  // sessions differ from run to run, and decide nothing but ties of all else
  bool is_noise = false;     // no packet: the noise of vehicle source_id

  auto operator<=>(const PacketName&) const = default;
};

// A packet in the water.
struct Packet {
  SendRequest request;
  SimTime departure;  // of the first bit
  acoustics::PacketTiming timing;
  acoustics::Modem modem;               // as which the sender transmits it, decided when it was accepted
  Vec3 departure_ned_m = Vec3::Zero();  // where the first bit left
  Vec3 velocity_ned_mps = Vec3::Zero();
  std::shared_ptr<const Packet> answers = {};  // of an answer: the packet that asked for it
  std::int32_t rate_number = 0;
  acoustics::PacketFormat format = {};
  std::vector<std::int32_t> frame_bytes = {};  // of the payload in each frame of the format
  bool is_noise = false;                       // no packet: what a vehicle sounds like (vehicle_sounds.h)
  double energy_j = 0;                         // that it takes from the sender's battery; 0 without one

  PacketName name() const {
    return {request.source_id, request.packet_sequence, request.kind, request.destination_id,
            departure,         request.session,         is_noise};
  }
  LinkEnd link_end() const { return {request.source_id, departure_ned_m, velocity_ned_mps, &modem}; }
};
using PacketPointer = std::shared_ptr<const Packet>;  // never null

// What became of a packet at one possible receiver; in the order of packet_outcome_t. It is the first of
// these that holds, in the order of the numbers in brackets.
enum class OutcomeKind {
  kReceived,      // [13] none of the others: at least one frame was right
  kBelowCutoff,   // [5] all paths together are below the receiver's least receivable level
  kReceiverGone,  // [1] the receiver's state had grown too old at the first bit or at the last
  kShadow,        // [4] no path: the water bends every ray away
  kBlocked,       // [4] no path: the terrain stands in all
  kOutOfBand,     // [3] the bands of the two modems share nothing
  kCollided,      // [9] the receiver followed another packet; [10, 11] or without others it had been received
  kHalfDuplex,    // [7] the receiver transmitted at some instant of the packet
  kDoppler,       // [8] shifted by more than the receiver's modem follows
  kBitErrors,     // [11] acquired, with wrong bits in every frame
  kNotAcquired,   // [10] its preamble was not acquired
  kForeign,       // [2] the waveform families of the two modems differ: its detector does not know this sound
  kTooWeak,       // [4] no path: the bounces leave too little of every ray
  kTooSteep,      // [4] no path: every ray that arrives is launched more steeply than is searched
  kOutOfReach,    // [0] so far away at the departure that its sound cannot matter (propagation/reach.h)
  kAsleep,        // [6] the receiver's modem slept at some instant of the packet
  kExtraLoss,     // [12] none of the others, but lost on purpose (extra_loss.h)
  kNoPower,       // [1] the receiver's battery was empty at the first bit or at the last
};

// What the outcome was decided by.
struct DecisionStatistics {
  Decibels interference = kSilence;    // mean over the bits, dB re 1 uPa in the packet's band
  Decibels sinr;                       // over the bits; 0 unless it came to that
  double acquisition_probability = 0;  // 0 unless it came to that
  double success_probability = 0;      // of at least one frame being right; 0 unless it came to that
  double acquisition_draw = 0;         // in (0, 1): acquired when below the probability
  double success_draw = 0;             // likewise, of the header and the first frame
  std::vector<PacketName> colliders;   // the loudest first, 16 at most
  std::uint32_t frames_good = 0;       // bit i: frame i was right
};

// The outcome of a packet at one possible receiver; or, kOutOfReach, at all that are out of reach but for its
// destination.
struct PacketOutcome {
  PacketPointer packet;
  VehicleId receiver_id = 0;  // 0: several receivers
  std::size_t receivers = 1;  // that it stands for
  std::string receiver;       // its name when the packet left
  OutcomeKind kind = OutcomeKind::kReceived;
  bool deliver =
      false;  // received, and addressed to this receiver or to all, or this receiver is promiscuous
  double travel_time_s = 0;  // of the first significant path
  SimTime departure_stamp;   // the departure by the sender's clock
  // As the receiver's modem measures it: with noise, in steps of its time quantum, by its own clock less the
  // stamp.
  double measured_travel_time_s = 0;
  double two_way_travel_time_s = 0;  // likewise by its own clock, of an answer: out and back; else 0
  acoustics::LinkBudget budget;      // from the sender at departure to the receiver at arrival
  Decibels cutoff;                   // the receiver's, dB re 1 uPa
  PropagationUsed propagation = PropagationUsed::kStraight;
  std::size_t path_count = 0;
  double delay_spread_s = 0;
  double doppler_factor = 1;         // of the strongest path; 1 without a path
  double arrival_azimuth_rad = 0;    // towards where the sound came from, from north by east, -pi..pi
  double arrival_elevation_rad = 0;  // likewise, from the horizontal, positive up
  DecisionStatistics statistics;
  // Its SEND came so late that its sound overlaps, here or where it left, a reception that was decided
  // without it.
  bool is_too_late = false;
  double receive_energy_j = 0;  // taken from the receiver's battery; 0 unless acquired, and without one
};

}  // namespace halocline::channel_server
