// SPDX-License-Identifier: BSD-3-Clause
// The links between the vehicles of a recorded run: what arrives of a sound that one of them makes.
//
// Paths are searched for every kFrame of the departure, every search anew: a cell that shares one would step. The gains of paths are
// those of a modem's band; absorption at other frequencies than its centre is that of the way of the first significant path, half way
// between the depths of the ends.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "acoustics/modem/modem.h"
#include "acoustics/sea/environment.h"
#include "acoustics/waveform/moving_link.h"
#include "bathymetry/terrain/terrain.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "channel_server/water_model.h"
#include "clients/halocline/analysis/recording.h"
#include "clients/halocline/scenario/composition.h"
#include "clients/halocline/scenario/vehicle_track.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::clients {

inline constexpr SimDuration kFrame = SimDuration::from_milliseconds(20);

// Of a level re 1 uPa, uPa; of any ratio.
double amplitude_of(Decibels level);

// From a vehicle, as one with that modem, to another.
struct Way {
  acoustics::MovingLink link;
  double length_m, depth_m;  // means over the time of departure
  double centre_hz;
};

class ScenarioLinks {
 public:
  // All must outlive it but `config`.
  ScenarioLinks(const ScenarioConfig& config, const bathymetry::Terrain& terrain, const Recording& run);

  const acoustics::Environment& water(SimTime at) const { return water_.propagation->environment(at); }
  // Throws InvalidArgument where there is no such vehicle.
  std::int32_t id_of(const std::string& vehicle) const;
  const acoustics::Modem& modem_of(const std::string& vehicle) const { return modems_.of(vehicle).modem; }

  // Of what leaves between those times.
  Way between(const std::string& from, const acoustics::Modem& sender, const std::string& to, double begin_s,
              double end_s);
  // Adds what arrives by it of a sound, pressure at 1 m.
  void add_received(const Way& way, const acoustics::Samples& sound, acoustics::Samples& received) const;

 private:
  struct End {
    std::int32_t id;
    const acoustics::Modem& modem;
    VehicleTrack::Place place;
    channel_server::LinkEnd link_end() const {
      return {id, place.position_ned_m, place.velocity_ned_mps, &modem};
    }
  };

  channel_server::Reception reception_of(SimTime departure, const End& from, End to,
                                         const VehicleTrack& receiver, double& delay_s);

  ScenarioConfig config_;
  const Recording& run_;
  channel_server::ConfiguredModems modems_;
  const bathymetry::Terrain& terrain_;
  channel_server::WaterModel water_;
};

}  // namespace halocline::clients
