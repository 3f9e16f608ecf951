// SPDX-License-Identifier: BSD-3-Clause
// Events of the medium: at packets, modems and batteries.
#pragma once

#include <cstdint>
#include <string>
#include <variant>

#include "channel_server/packets/packet.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::channel_server {

// The energy that one packet takes from a vehicle's battery. A sender spends all of it at the departure; a
// receiver that acquired the packet spends it at the packet's end, whatever the outcome.
struct EnergyUse {
  std::string vehicle;
  bool is_transmission = true;
  double energy_j = 0;
  PacketName packet;
};

// The kind of a modem's event. The enumerators have the values of modem_event_t.
enum class ModemEventKind {
  kTransmissionBegan,
  kTransmissionEnded,
  kPacketDetected,  // at the end of the preamble
  kPacketEnded,     // at the last bit of a detected packet
  kCarrierBegan,
  kCarrierEnded,
  kHeaderReceived,  // header of a detected packet: its source and destination are known
};

// An event at a modem: a transmission of its own or something that it detects (modem_watch.h).
struct ModemEvent {
  std::string vehicle;
  ModemEventKind kind = ModemEventKind::kTransmissionBegan;
  std::int64_t session = 0, packet_sequence = 0;  // for an own transmission
  Decibels level = {};  // level of the packet or carrier, dB re 1 uPa; 0 for an own transmission
  Decibels sinr = {};   // for a packet that ended
  OutcomeKind outcome = OutcomeKind::kReceived;  // for a packet that ended
  // Set for a received header and for a received packet.
  VehicleId source_id = 0, destination_id = 0;
  SimDuration packet_duration = {};  // duration at the sender
  SimTime packet_end = {};           // arrival of its last bit at the receiver
  std::int32_t rate_number = 0;      // for a detected packet
  SimTime measured_arrival = {};     // only at a detection: the arrival as measured (PacketOutcome)
};

// An event of the medium and its instant.
struct MediumEvent {
  SimTime at;  // exactly when it happened
  // The event; a ModemReply only when other shards need it.
  std::variant<Receipt, PacketOutcome, ModemReply, ModemEvent, EnergyUse> what;
  bool late = false;  // the medium had advanced beyond `at` before it could know of the event
};

}  // namespace halocline::channel_server
