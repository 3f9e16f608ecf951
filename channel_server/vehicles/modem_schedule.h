// SPDX-License-Identifier: BSD-3-Clause
// What a vehicle's modem is and how it listens at an instant: as configured, until the vehicle announces
// otherwise.
//
// Announcements hold from the instant they name, whatever their order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "acoustics/modem/modem.h"
#include "channel_server/vehicles/modem_rates.h"
#include "channel_server/vehicles/schedule.h"
#include "core/files/file_path.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::channel_server {

// What a modem does on a request to send while it is sending.
enum class WhenBusy {
  kRefuse,  // the transmission is refused
  kQueue,   // it starts when those before it have ended
};

// How a modem receives, and what it reports of that.
struct Listening {
  bool asleep = false;                // acquires nothing and senses no carrier; it transmits all the same
  std::optional<SimTime> wakes = {};  // of one asleep: by itself, at this instant
  bool promiscuous = false;           // packets for others are received as well
  bool events = false;                // what it does and notices is reported (packets/modem_watch.h)
  // Carrier is sensed where the sound of others exceeds the noise in the modem's band by this, 0..100 dB. 6
  // dB is our choice: over 10 ms and 5 kHz the power of noise is known within 0.6 dB, so noise alone does not
  // get there.
  Decibels carrier_threshold{6};

  bool is_asleep(SimTime instant) const { return asleep && !(wakes && instant >= *wakes); }
  bool operator==(const Listening&) const = default;
};

// The profile whose packets may be of any form.
inline const std::string kGenericProfile = "generic";

struct VehicleModem {
  acoustics::Modem modem;
  std::int32_t max_payload_bytes = 4096;  // of one packet, 0..32 768; the modem's own limit holds as well
  WhenBusy when_busy = WhenBusy::kRefuse;
  FilePath profile = kGenericProfile;  // where the numbers come from: a name, or the path of a file
  std::int32_t rate_number = 0;        // of the modem's own rate, 0..255
  RateSet rates = {};                  // the other rates that it sends and receives, by number
  Listening listening = {};            // at the start; then as the vehicle announces
  bool fitted = true;                  // false: the vehicle carries no modem at all
  bool operator==(const VehicleModem&) const = default;
};

// As which modem the vehicle receives a packet of this one: its own, unless a rate of another family knows
// the packet's.
inline const acoustics::Modem& receiving_modem(const VehicleModem& receiver, const acoustics::Modem& packet) {
  if (same_family(packet, receiver.modem)) return receiver.modem;
  const ModemRate* rate =
      receiver.rates.find([&](const ModemRate& r) { return same_family(packet, r.modem); });
  return rate == nullptr ? receiver.modem : rate->modem;
}

// The largest payload of one packet that both limits allow.
inline std::size_t largest_payload_bytes(const VehicleModem& modem) {
  return std::min(static_cast<std::size_t>(modem.max_payload_bytes), max_payload_bytes(modem.modem));
}

using ModemSchedule = Schedule<VehicleModem>;
using ListenSchedule = Schedule<Listening>;

}  // namespace halocline::channel_server
