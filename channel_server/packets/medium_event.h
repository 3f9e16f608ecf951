// SPDX-License-Identifier: BSD-3-Clause
// What happens in the medium: to packets, at modems and to batteries.
#pragma once

#include <cstdint>
#include <string>
#include <variant>

#include "channel_server/packets/packet.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::channel_server {

// What one packet takes from a vehicle's battery: of its sender whole at the departure, of a receiver that
// acquired it, whatever became of it, at its end.
struct EnergyUse {
  std::string vehicle;
  bool is_transmission = true;
  double energy_j = 0;
  PacketName packet;
};

// In the order of modem_event_t.
enum class ModemEventKind {
  kTransmissionBegan,
  kTransmissionEnded,
  kPacketDetected,  // at the end of its preamble
  kPacketEnded,     // the last bit of one detected
  kCarrierBegan,
  kCarrierEnded,
  kHeaderReceived,  // of one detected: whose it is, and for whom
};

// What a modem does or notices (modem_watch.h).
struct ModemEvent {
  std::string vehicle;
  ModemEventKind kind = ModemEventKind::kTransmissionBegan;
  std::int64_t session = 0, packet_sequence = 0;  // of an own transmission
  Decibels level = {};  // of the packet or carrier, dB re 1 uPa; 0 of an own transmission
  Decibels sinr = {};   // of a packet that ended
  OutcomeKind outcome = OutcomeKind::kReceived;  // likewise
  // Of a header that was received, or a packet that was.
  VehicleId source_id = 0, destination_id = 0;
  SimDuration packet_duration = {};  // as sent
  SimTime packet_end = {};           // of its last bit at the receiver
  std::int32_t rate_number = 0;      // of a packet that was detected
  SimTime measured_arrival = {};     // likewise, at its detection alone (PacketOutcome)
};

struct MediumEvent {
  SimTime at;  // exactly when it happened
  // Answers only for other shards.
  std::variant<Receipt, PacketOutcome, ModemReply, ModemEvent, EnergyUse> what;
  bool late = false;  // the medium had been advanced beyond `at` before it could know of this
};

}  // namespace halocline::channel_server
