// What the packet medium takes in and gives out: transmissions asked for, receipts, and the ends of packets.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "acoustics/link_budget.h"
#include "channel_server/fleet.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

// Transmit this: `session` and `packet_sequence` are the sender's names for it.
struct SendRequest {
  std::string vehicle;           // who asks, by the channel it asked on
  VehicleId source_id = 0;       // who it says it is
  VehicleId destination_id = 0;  // kBroadcastId for all
  std::int64_t session = 0;      // 0 where the sender keeps none
  std::int64_t packet_sequence = 0;
  SimTime start;  // when the first bit is to leave
  std::vector<std::uint8_t> payload;
};

enum class SendResult {
  kAccepted,
  kBusy,            // another transmission of this modem overlaps this one
  kTooLarge,        // the payload is beyond the modem's largest
  kUnknownVehicle,  // no fresh state at the start: nowhere to transmit from
  kWrongSource,     // source_id is not the id of the vehicle
  kStale,           // the start lies too far in the past
  kTooEarly,        // the start lies too far in the future
};

struct Receipt {
  std::string vehicle;
  std::int64_t session = 0;
  std::int64_t packet_sequence = 0;
  SendResult result = SendResult::kAccepted;
  SimTime start = {};         // 0 unless accepted
  SimDuration duration = {};  // 0 unless accepted
};

// A packet in the water.
struct Packet {
  SendRequest request;
  SimDuration duration;
  acoustics::Modem modem;               // of the sender at departure
  Vec3 departure_ned_m = Vec3::Zero();  // where the first bit left
};

enum class PacketFate {
  kReceived,      // level at or above the receiver's cut-off, bands overlap, receiver still there
  kBelowCutoff,   // too weak, or in no band of the receiver
  kReceiverGone,  // the receiver's state had grown too old at the first bit or at the last
};

// The end of a packet at one possible receiver.
struct PacketEnd {
  std::shared_ptr<const Packet> packet;
  VehicleId receiver_id = 0;
  std::string receiver;  // its name when the packet left
  PacketFate fate = PacketFate::kReceived;
  bool deliver = false;          // received, and addressed to this receiver or to all
  double travel_time_s = 0;      // of the first bit
  acoustics::LinkBudget budget;  // from the sender at departure to the receiver at the first bit
  Decibels cutoff;               // the receiver's, dB re 1 uPa
};

struct MediumEvent {
  SimTime at;         // exactly when it happened
  bool late = false;  // the medium had been advanced beyond `at` before it could know of this
  std::variant<Receipt, PacketEnd> what;
};

}  // namespace halocline::channel_server
