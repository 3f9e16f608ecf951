// SPDX-License-Identifier: BSD-3-Clause
// What the noise of vehicles does at a receiver: to the reception of a packet, and to link tables.
//
// The receiver's own noise adds to the ambient noise over the packet's band. The noise of every other vehicle
// comes along the paths of sound from where it was, as far as its reach (propagation/reach.h) goes: with the
// mean power of all paths and the large-scale fading of the link, as the sound of packets does. It left where
// a straight line puts it to arrive with the packet, is as loud as it was then for the whole of the packet,
// and disturbs like a packet that sounds all the while: by name, among the colliders. Left out: how it
// changes during the packet, and its delays along several paths. Link tables state the mean over fading.
#pragma once

#include <cstdint>
#include <vector>

#include "acoustics/fading/path_fading.h"
#include "acoustics/math/frequency_band.h"
#include "acoustics/noise/noise_variation.h"
#include "channel_server/packets/flight.h"
#include "channel_server/packets/noise_level_cache.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/receiver_state.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/reach.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_noise.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::channel_server {

// A receiver in a band of its own or of a packet's, at an instant, as decided at another.
struct Hearing {
  LinkEnd receiver;
  acoustics::Band band;
  SimTime at, decided_at;
  VehicleId silent = 0;  // another vehicle whose noise is left out; 0: none
};

class VehicleSounds {
 public:
  // All must outlive it; without `reach` all are heard.
  VehicleSounds(const VehicleRegistry& fleet, Propagation& propagation, ReachModel* reach,
                const acoustics::FadingModel& fading, const acoustics::NoiseVariation& variation,
                std::uint64_t seed)
      : fleet_(fleet),
        propagation_(propagation),
        reach_(reach),
        fading_(fading),
        variation_(variation),
        seed_(seed) {}

  // Whether there are vehicles that make any.
  bool any() const { return !fleet_.equipment().noise.sources().empty(); }
  // Whether the noise at a receiver may be another than the ambient one of the environment.
  bool differ() const { return any() || variation_.spread_db > 0; }
  // Power over the band that the receiver hears of itself at `at`, uPa^2.
  double own_power(VehicleId receiver, const acoustics::Band& band, SimTime at, SimTime decided_at) const;
  // Over the band, ambient and the receiver's own, dB re 1 uPa.
  Decibels noise_level(VehicleId receiver, const acoustics::Band& band, SimTime at, SimTime decided_at);
  // Sets the noise level in the packet's band, ambient and the receiver's own, and the noise of other
  // vehicles beside it.
  void set_noise(Flight& flight, SimTime decided_at);
  // Of a flight whose arrival is solved: whether the propagation knows all that set_noise() needs, as
  // Propagation::is_ready.
  bool are_ready(const Flight& flight, SimTime decided_at);

  // Over the band, ambient, the receiver's own and the mean power of all others, dB re 1 uPa.
  Decibels mean_level(const Hearing& hearing);
  // By how much that exceeds the ambient noise of the environment, dB.
  Decibels above_ambient(const Hearing& hearing);
  // Whether the propagation knows all that these need, as Propagation::is_ready.
  bool is_ready(const Hearing& hearing);

 private:
  double speed_of(const NoiseOf& noise, SimTime at, SimTime decided_at) const;
  std::vector<PacketPointer> sounds_within_reach(const Hearing& hearing);
  PacketPointer sound_of(const NoiseOf& noise, const Hearing& hearing) const;
  // The mean power of the noise of all other vehicles at the receiver, by their id.
  std::vector<NoiseSound> others(const Hearing& hearing);

  const VehicleRegistry& fleet_;
  Propagation& propagation_;
  ReachModel* reach_;
  NoiseLevelCache ambient_;
  acoustics::FadingModel fading_;
  acoustics::NoiseVariation variation_;
  std::uint64_t seed_;
};

// All other packets at the flight's receiver during [begin, end), and the noise of other vehicles, which
// sounds all the while.
Interferers interferers_of(const Flight& flight, const ReceiverState& receiver, SimTime begin, SimTime end);

}  // namespace halocline::channel_server
