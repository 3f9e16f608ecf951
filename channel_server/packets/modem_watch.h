// SPDX-License-Identifier: BSD-3-Clause
// What modems notice besides whole packets, for those that report it (Listening::events): their own
// transmissions, packets detected, and carrier.
//
// Carrier. Each path of each packet of others counts with its mean power in the modem's band while it sounds.
// Carrier is sensed where their sum exceeds the noise of the band, less the directivity index, by the modem's
// carrier_threshold:
//   sum_i P_i(t) > 10^(threshold / 10) N
// Changes come at the exact instants at which the sum passes that level, but not within kCarrierHold of the
// one before: a detector of energy averages over so much. A modem that transmits or sleeps senses nothing.
// The noise is that of the instant at which sound last began or ended.
//
// Each TRANSMISSION_ENDED, PACKET_ENDED and CARRIER_ENDED follows its beginning, even where the modem reports
// no more by then. Bounded: two events for a transmission, three for a packet followed (one at a time), 100
// changes of carrier a second. Not thread-safe.
#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "channel_server/packets/flight.h"
#include "channel_server/packets/medium_event.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/receiver_state.h"
#include "channel_server/packets/vehicle_sounds.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

class ModemWatch {
 public:
  static constexpr SimDuration kCarrierHold = SimDuration::from_milliseconds(10);

  // All must outlive it.
  ModemWatch(const VehicleRegistry& fleet, VehicleSounds& sounds) : fleet_(fleet), sounds_(sounds) {}

  // A packet leaves now.
  void begin_transmission(const Packet& packet, std::vector<MediumEvent>& events);
  // When the next transmission that was reported ends, or the next header of a packet that was; never()
  // without one.
  SimTime next_end() const { return std::min(next_of(ends_), next_of(headers_)); }
  void end_transmission_or_header(std::vector<MediumEvent>& events);

  // The receiver of a flight has acquired its packet, at the end of the preamble.
  void detect(Flight& flight, std::vector<MediumEvent>& events);
  // The last bit of a packet, detected or not.
  static void end(const Flight& flight, SimTime at, OutcomeKind outcome, std::vector<MediumEvent>& events);

  // What is heard at a vehicle, or how its modem listens, changes at `at`: its carrier is to be judged then,
  // after all else of that instant. Nothing where the modem reports nothing.
  void judge_carrier_at(VehicleId id, SimTime at);
  SimTime next_carrier() const { return due_.empty() ? SimTime::never() : due_.begin()->first; }
  // Of whom next_carrier() is; only while there is one.
  VehicleId next_to_judge() const { return due_.begin()->second; }
  // `heard` by that vehicle.
  void judge_carrier(const ReceiverState& heard, std::vector<MediumEvent>& events);

  void forget_before(SimTime time);
  void clear();

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
  // Whether the header of a packet that was detected is right, at its last bit.
  bool has_header(const Flight& flight, SimTime end) const;
  void change(VehicleId id, Carrier& carrier, SimTime at, double power, std::vector<MediumEvent>& events);

  const VehicleRegistry& fleet_;
  VehicleSounds& sounds_;
  ByEnd<ModemEvent> ends_;        // of transmissions
  ByEnd<const Flight*> headers_;  // of packets that are followed, until their headers end
  std::map<VehicleId, Carrier> carriers_;
  std::set<std::pair<SimTime, VehicleId>> due_;  // to judge once too often changes nothing
};

}  // namespace halocline::channel_server
