// SPDX-License-Identifier: BSD-3-Clause
// The noise of vehicles at a receiver: in the reception of a packet, and in link tables.
//
// The receiver's own noise adds to the ambient noise over the packet's band. The noise of every other vehicle
// within its reach (propagation/reach.h) arrives along the eigenrays from that vehicle's position, with the
// mean power of all paths and the large-scale fading of the link, as the sound of packets does. Its departure
// is taken as the arrival of the packet less the travel time along the straight line. It keeps the loudness
// of that departure for the whole of the packet. It disturbs like a packet that sounds all the while, and is
// named among the colliders; being noise, it meets the receiver's loss (Modem::receiver_loss) as the sea's
// does. Not modelled: changes of the noise during the packet, and its delays along several paths. Link tables
// state the mean over fading.
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

// A query for the noise at a receiver, in its own band or a packet's, at the instant `at`, with the states
// known at `decided_at`.
struct NoiseQuery {
  LinkEnd receiver;
  acoustics::Band band;
  SimTime at, decided_at;
  VehicleId silent = 0;  // another vehicle whose noise is left out; 0 for none
};

class PlatformNoise {
 public:
  // The references must outlive this object. Without `reach` every vehicle is heard.
  PlatformNoise(const VehicleRegistry& fleet, Propagation& propagation, ReachModel* reach,
                const acoustics::FadingModel& fading, const acoustics::NoiseVariation& variation,
                std::uint64_t seed)
      : fleet_(fleet),
        propagation_(propagation),
        reach_(reach),
        fading_(fading),
        variation_(variation),
        seed_(seed) {}

  // True when some vehicle makes noise.
  bool any() const { return !fleet_.equipment().noise.sources().empty(); }
  // True when some vehicle's noise is heard by others.
  bool any_is_heard() const { return fleet_.equipment().noise.are_heard(); }
  // True when the noise at a receiver may differ from the ambient noise of the environment.
  bool differ() const { return any() || variation_.changes_level(); }
  // Returns the power over the band of the receiver's own noise at its hydrophone at `at`, uPa^2.
  double own_power(VehicleId receiver, const acoustics::Band& band, SimTime at, SimTime decided_at) const;
  // Returns the level over the band of ambient and own noise, dB re 1 uPa.
  Decibels noise_level(VehicleId receiver, const acoustics::Band& band, SimTime at, SimTime decided_at);
  // Sets the level of ambient and own noise in the packet's band, and the noise of other vehicles.
  void set_noise(Flight& flight, SimTime decided_at);
  // True when the propagation knows all that set_noise() needs for a flight whose arrival is solved; as
  // Propagation::is_ready, it requests what is missing.
  bool are_ready(const Flight& flight, SimTime decided_at);

  // Returns the level over the band of ambient noise, own noise and the mean noise of all other vehicles, dB
  // re 1 uPa.
  Decibels mean_level(const NoiseQuery& query);
  // Returns mean_level() less the ambient noise of the environment, dB.
  Decibels above_ambient(const NoiseQuery& query);
  // True when the propagation knows all that these two need; as Propagation::is_ready, it requests what is
  // missing.
  bool is_ready(const NoiseQuery& query);

 private:
  double speed_of(const NoiseSource& noise, SimTime at, SimTime decided_at) const;
  std::vector<PacketPointer> sounds_within_reach(const NoiseQuery& query);
  PacketPointer sound_of(const NoiseSource& noise, const NoiseQuery& query) const;
  // Returns the mean noise power of each other vehicle at the receiver, sorted by vehicle id.
  std::vector<NoiseSound> others(const NoiseQuery& query);

  const VehicleRegistry& fleet_;
  Propagation& propagation_;
  ReachModel* reach_;
  NoiseLevelCache ambient_;
  acoustics::FadingModel fading_;
  acoustics::NoiseVariation variation_;
  std::uint64_t seed_;
};

// Returns all other packets at the flight's receiver during [begin, end), and the noise of other vehicles,
// which lasts for the whole packet.
Interferers interferers_of(const Flight& flight, const ReceiverState& receiver, SimTime begin, SimTime end);

}  // namespace halocline::channel_server
