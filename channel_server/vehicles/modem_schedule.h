// SPDX-License-Identifier: BSD-3-Clause
// Modem and listening mode of a vehicle over time: as configured until the vehicle announces a change.
//
// Announcements hold from the instant that they name, whatever the order in which they arrive.
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

// Reaction of a modem to a request to send while it is sending.
enum class WhenBusy {
  kRefuse,  // the transmission is refused
  kQueue,   // the transmission starts when those before it have ended
};

// Listening mode: how a modem receives, and what it reports of that.
struct Listening {
  bool asleep = false;                // acquires nothing and senses no carrier; it can still transmit
  std::optional<SimTime> wakes = {};  // a sleeping modem wakes by itself at this instant
  bool promiscuous = false;           // packets addressed to others are received too
  bool events = false;                // actions and detections are reported (packets/modem_watch.h)
  // Carrier is sensed where the sound of others exceeds the noise in the modem's band by this, 0..100 dB. 6
  // dB is our choice: the power of noise over 10 ms and 5 kHz is known within 0.6 dB, so noise alone does not
  // reach it.
  Decibels carrier_threshold{6};

  bool is_asleep(SimTime instant) const { return asleep && !(wakes && instant >= *wakes); }
  bool operator==(const Listening&) const = default;
};

// Profile whose packets may have any form.
inline const std::string kGenericProfile = "generic";

struct VehicleModem {
  acoustics::Modem modem;
  std::int32_t max_payload_bytes = 4096;  // limit of one packet, 0..32 768; the modem's own limit holds too
  WhenBusy when_busy = WhenBusy::kRefuse;
  FilePath profile = kGenericProfile;  // source of the numbers: a name, or the path of a file
  std::int32_t rate_number = 0;        // number of the modem's own rate, 0..255
  RateSet rates = {};                  // other rates that it sends and receives, by number
  Listening listening = {};            // initial mode, until the vehicle announces another
  bool fitted = true;                  // false: the vehicle carries no modem
  bool operator==(const VehicleModem&) const = default;
};

// Returns the modem with which the vehicle receives `packet`: its own, unless only a rate of another family
// is of the packet's family.
inline const acoustics::Modem& receiving_modem(const VehicleModem& receiver, const acoustics::Modem& packet) {
  if (same_family(packet, receiver.modem)) return receiver.modem;
  const ModemRate* rate =
      receiver.rates.find([&](const ModemRate& r) { return same_family(packet, r.modem); });
  return rate == nullptr ? receiver.modem : rate->modem;
}

// Returns the largest payload of one packet that both limits allow, bytes.
inline std::size_t largest_payload_bytes(const VehicleModem& modem) {
  return std::min(static_cast<std::size_t>(modem.max_payload_bytes), max_payload_bytes(modem.modem));
}

using ModemSchedule = Schedule<VehicleModem>;
using ListenSchedule = Schedule<Listening>;

}  // namespace halocline::channel_server
