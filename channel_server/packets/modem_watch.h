// SPDX-License-Identifier: BSD-3-Clause
// The events that modems report besides whole packets, if they report any (Listening::events): their own
// transmissions, detections of packets, and carrier.
//
// Carrier. Each path of each packet from other modems counts with its mean power P_i in the modem's band
// while it sounds. Carrier is sensed when the sum exceeds the noise power N of the band, less the directivity
// index, by the modem's carrier_threshold, dB:
//   sum_i P_i(t) > 10^(threshold / 10) N
// Changes are reported at the exact instants at which the sum crosses that level, but at least kCarrierHold
// apart: an energy detector averages over about that time. A modem that transmits or sleeps senses nothing. N
// is the noise at the instant at which a sound last began or ended.
//
// Each TRANSMISSION_ENDED, PACKET_ENDED and CARRIER_ENDED follows its beginning, even if the modem has
// stopped reporting by then. The number of events is bounded: two for a transmission, three for a packet that
// is followed (one at a time), and 100 carrier changes a second. Not thread-safe.
#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "channel_server/packets/flight.h"
#include "channel_server/packets/medium_event.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/platform_noise.h"
#include "channel_server/packets/receiver_state.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

class ModemWatch {
 public:
  static constexpr SimDuration kCarrierHold = SimDuration::from_milliseconds(10);

  // The references must outlive this object.
  ModemWatch(const VehicleRegistry& fleet, PlatformNoise& sounds) : fleet_(fleet), sounds_(sounds) {}

  // Reports the begin of a transmission, and schedules the report of its end.
  void begin_transmission(const Packet& packet, std::vector<MediumEvent>& events);
  // Returns when the next reported transmission ends, or the next header of a detected packet; never()
  // without one.
  SimTime next_end() const { return std::min(next_of(ends_), next_of(headers_)); }
  void end_transmission_or_header(std::vector<MediumEvent>& events);

  // Reports that the receiver of a flight has acquired its packet, at the end of the preamble.
  void detect(Flight& flight, std::vector<MediumEvent>& events);
  // Reports the end of a packet at its last bit, if its detection was reported.
  static void end(const Flight& flight, SimTime at, OutcomeKind outcome, std::vector<MediumEvent>& events);

  // Schedules an update of a vehicle's carrier at `at`, after all else of that instant, because what is heard
  // there or how its modem listens changes then. Does nothing when the modem reports no events.
  void update_carrier_sense_at(VehicleId id, SimTime at);
  SimTime next_carrier() const { return due_.empty() ? SimTime::never() : due_.begin()->first; }
  // Returns the vehicle of next_carrier(); requires that there is one.
  VehicleId next_to_update() const { return due_.begin()->second; }
  // Updates the carrier of next_to_update(); `heard` holds the sounds at that vehicle.
  void update_carrier_sense(const ReceiverState& heard, std::vector<MediumEvent>& events);

  void forget_before(SimTime time);

 private:
  struct Carrier {
    bool sensed = false;
    SimTime changed = SimTime::at_once();
  };
  template <class Value>
  using ByEnd = std::map<std::pair<SimTime, VehicleId>, Value>;
  template <class Value>
  static SimTime next_of(const ByEnd<Value>& ends) {
    return ends.empty() ? SimTime::never() : ends.begin()->first.first;
  }
  // True when the header of a detected packet is right at its last bit.
  bool has_header(const Flight& flight, SimTime end) const;
  void change(VehicleId id, Carrier& carrier, SimTime at, double power, std::vector<MediumEvent>& events);

  const VehicleRegistry& fleet_;
  PlatformNoise& sounds_;
  ByEnd<ModemEvent> ends_;        // reported transmissions that have not ended
  ByEnd<const Flight*> headers_;  // packets that are followed, by the end of their headers
  std::map<VehicleId, Carrier> carriers_;
  std::set<std::pair<SimTime, VehicleId>> due_;  // an update that is not needed changes nothing
};

}  // namespace halocline::channel_server
