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
#include "acoustics/reception/disturbing_powers.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::channel_server {

// The kind of a packet. The enumerators have the values of modem_send_t.
enum class PacketKind {
  kData,
  // A ping. One to a single vehicle is answered by its modem without the user's program; one to all is
  // answered by every transponder (vehicle_equipment.h).
  kPing,
  // The answer to a ping; carries session and packet_sequence of the ping.
  kPingReply,
  // The acknowledgement of a packet that asks for one; carries session and packet_sequence of that packet.
  // Its payload says which frames were right.
  kAck,
  kMiniPacket,  // a packet of a few bits
  kJanus,       // a JANUS baseline packet without cargo
  kJanusCargo,  // a JANUS baseline packet with cargo
};

// True for packets that modems send without being asked by a user's program: ping replies and
// acknowledgements.
constexpr bool is_answer(PacketKind kind) {
  return kind == PacketKind::kPingReply || kind == PacketKind::kAck;
}

// The turnaround time of a modem that answers: from the last bit of a packet to the first bit of the answer.
// The last bit is taken at the packet's first arrival plus its duration at the sender. The value is chosen so
// that it leaves time to decode and to turn from receiving to sending, and exceeds the lengthening of any
// packet by Doppler (10 ms of 3 s at 5 m/s). Both ends know it, so the sender of the packet can subtract it.
inline constexpr SimDuration kReplyTurnaround = SimDuration::from_milliseconds(100);

// A request to transmit a packet. `session` and `packet_sequence` are the sender's names for it.
struct SendRequest {
  std::string vehicle;           // from the name of the LCM channel of the request
  VehicleId source_id = 0;       // the id stated in the request
  VehicleId destination_id = 0;  // kBroadcastId for all
  std::int64_t session = 0;      // 0 if the sender keeps no session
  std::int64_t packet_sequence = 0;
  SimTime start;  // departure of the first bit; a modem that queues may send it later
  std::vector<std::uint8_t> payload;
  PacketKind kind = PacketKind::kData;
  bool stamped = true;     // the packet carries the instant of its departure by the sender's clock
  bool wants_ack = false;  // only to one vehicle: its modem shall acknowledge the packet
  std::optional<std::int32_t> rate_number = {};  // empty: the modem's own rate
  std::optional<Decibels> source_level = {};     // dB re 1 uPa at 1 m; empty: the modem's own
  std::int32_t header_number = 0;                // carried by the header, 0..255, chosen by the sender
  // Bytes of the payload in each frame; empty: as the modem divides it.
  std::vector<std::int32_t> frame_bytes = {};
};

// True when the receiver's modem answers the packet: a ping, or a packet that asks for an acknowledgement.
inline bool wants_answer(const SendRequest& request) {
  return request.kind == PacketKind::kPing || request.wants_ack;
}

// An answer that a modem sends without its user's program, and the departure and duration of the packet that
// it answers.
struct ModemReply {
  SendRequest request;  // the answer; its start is when it leaves
  SimTime asked_departure;
  SimDuration asked_duration;
};

// The medium's decision about a request to transmit. The enumerators have the values of modem_receipt_t.
enum class SendResult {
  kAccepted,
  kBusy,            // another transmission of this modem overlaps this one
  kTooLarge,        // the payload or a frame exceeds what the modem sends in a packet of this kind
  kUnknownVehicle,  // no fresh state at the start, so no place to transmit from
  kWrongSource,     // source_id is not the id of the vehicle
  kStale,           // the start lies too far in the past
  kTooEarly,        // the start lies too far in the future
  kQueued,          // accepted; starts when the transmissions before it have ended
  kQueueFull,       // the modem queues, and too many wait already
  kNoRate,          // the modem has no rate of that number
  kNoKind,          // the modem has no packets of that kind, or not at that rate
  kNoModem,         // the vehicle carries no modem, or its battery is empty
};

// The answer to a request to transmit: its result, and when and for how long the packet is transmitted.
struct Receipt {
  std::string vehicle;
  std::int64_t session = 0;
  std::int64_t packet_sequence = 0;
  SendResult result = SendResult::kAccepted;
  SimTime start = {};         // 0 unless accepted or queued
  SimDuration duration = {};  // 0 unless accepted or queued
};

// The name of a packet, unique among all packets in the water.
struct PacketName {
  VehicleId source_id = 0;
  std::int64_t packet_sequence = 0;
  PacketKind kind = PacketKind::kData;
  VehicleId destination_id = 0;
  SimTime departure;
  // Sessions differ between runs, so the session decides only between names that are equal in all else.
  std::int64_t session = 0;
  bool is_noise = false;  // not a packet but the noise of vehicle source_id

  auto operator<=>(const PacketName&) const = default;
};

// A packet in the water.
struct Packet {
  SendRequest request;
  SimTime departure;  // departure of the first bit
  acoustics::PacketTiming timing;
  acoustics::Modem modem;               // the sender's modem, as it was when the packet was accepted
  Vec3 departure_ned_m = Vec3::Zero();  // the sender's position when the first bit leaves
  Vec3 velocity_ned_mps = Vec3::Zero();
  std::shared_ptr<const Packet> answers = {};  // for an answer: the packet that it answers; else null
  std::int32_t rate_number = 0;
  acoustics::PacketFormat format = {};
  std::vector<std::int32_t> frame_bytes = {};  // bytes of the payload in each frame of the format
  bool is_noise = false;                       // not a packet but the noise of a vehicle (platform_noise.h)
  double energy_j = 0;                         // taken from the sender's battery; 0 without a battery
  bool out_of_water = false;                   // the sender is out of the water and makes no sound

  PacketName name() const {
    return {request.source_id, request.packet_sequence, request.kind, request.destination_id,
            departure,         request.session,         is_noise};
  }
  LinkEnd link_end() const { return {request.source_id, departure_ned_m, velocity_ned_mps, &modem}; }
};
using PacketPointer = std::shared_ptr<const Packet>;  // never null

// The outcome of a packet at one possible receiver. The enumerators have the values of packet_outcome_t. The
// conditions are tested in the order of the numbers in brackets, and the first that is true gives the
// outcome.
enum class OutcomeKind {
  kReceived,      // [13] no other outcome applies: at least one frame was right
  kBelowCutoff,   // [5] the level of all paths together is below the receiver's least receivable level
  kReceiverGone,  // [1] the receiver's state had grown too old at the first bit or at the last
  kShadow,        // [4] no path: refraction bends every ray away
  kBlocked,       // [4] no path: the terrain blocks every ray
  kOutOfBand,     // [3] the bands of the two modems do not overlap
  // [9] The receiver was following another packet; or [10, 11] the packet would have been received without
  // the other packets.
  kCollided,
  kHalfDuplex,   // [7] the receiver transmitted during part of the packet
  kDoppler,      // [8] the Doppler shift exceeds what the receiver's modem tolerates
  kBitErrors,    // [11] acquired, with wrong bits in every frame
  kNotAcquired,  // [10] its preamble was not acquired
  // [2] The two modems are of different waveform families: the receiver's detector does not respond.
  kForeign,
  kTooWeak,   // [4] no path: reflections attenuate every ray too much
  kTooSteep,  // [4] no path: every ray that arrives is launched more steeply than is searched
  // [0] Beyond the range, at departure, at which the packet can be received or disturb a reception
  // (propagation/reach.h).
  kOutOfReach,
  kAsleep,           // [6] the receiver's modem slept during part of the packet
  kExtraLoss,        // [12] otherwise received, but dropped on purpose (extra_loss.h)
  kNoPower,          // [1] the receiver's battery was empty at the first bit or at the last
  kOutOfWater = 18,  // [3] waves had left the sender or the receiver out of the water at the packet's middle
  kNoTerrain = 19,   // [4] the terrain ends or has no data on the way, and its last depth is not held
};

// The quantities that decided an outcome, and the random draws.
struct DecisionStatistics {
  Decibels interference = kSilence;         // mean over the bits, dB re 1 uPa in the packet's band
  Decibels sinr;                            // mean over the bits; 0 if the decision did not get that far
  double acquisition_probability = 0;       // 0 if the decision did not get that far
  double success_probability = 0;           // probability that at least one frame is right; 0 likewise
  double acquisition_draw = 0;              // in (0, 1); acquired when below acquisition_probability
  double success_draw = 0;                  // in (0, 1); decides the header and the first frame
  std::vector<PacketName> colliders;        // loudest first, at most 16
  std::uint32_t frames_good = 0;            // bit i is set when frame i was right
  acoustics::DisturbingPowers powers = {};  // 0 if the decision did not get that far
  acoustics::LossReason reason = acoustics::LossReason::kNone;  // of a packet not acquired or in error
};

// The outcome of a packet at one possible receiver. For kOutOfReach one outcome may represent several
// receivers: all that are out of reach except the packet's destination.
struct PacketOutcome {
  PacketPointer packet;
  VehicleId receiver_id = 0;  // 0 when the outcome represents several receivers
  std::size_t receivers = 1;  // number of receivers represented
  std::string receiver;       // the receiver's name when the packet left
  OutcomeKind kind = OutcomeKind::kReceived;
  // True when the packet was received, and was addressed to this receiver or to all, or this receiver is
  // promiscuous.
  bool deliver = false;
  double travel_time_s = 0;  // along the first significant path
  SimTime departure_stamp;   // the departure by the sender's clock
  // One-way travel time as the receiver's modem measures it: the arrival by the receiver's clock less the
  // departure stamp, with the timing error, rounded to the modem's time quantum.
  double measured_travel_time_s = 0;
  // Two-way travel time measured from an answer, by the clock of the vehicle that asked, with timing error
  // and rounding as above; 0 for other packets.
  double two_way_travel_time_s = 0;
  // The link budget from the sender at departure to the receiver at arrival.
  acoustics::LinkBudget budget;
  Decibels cutoff;  // the receiver's least receivable level, dB re 1 uPa
  PropagationUsed propagation = PropagationUsed::kStraight;
  std::size_t path_count = 0;
  double delay_spread_s = 0;
  double doppler_factor = 1;         // on the strongest path in the guard window; 1 without a path
  double arrival_azimuth_rad = 0;    // azimuth towards the source, clockwise from north, -pi..pi
  double arrival_elevation_rad = 0;  // elevation towards the source, from the horizontal, positive up
  DecisionStatistics statistics;
  // True when the request (SEND) came so late that the packet overlaps a reception that was already decided
  // without it, at this receiver or at the sender.
  bool conflicts_with_past = false;
  double receive_energy_j = 0;  // taken from the receiver's battery; 0 if not acquired or without a battery
};

}  // namespace halocline::channel_server
