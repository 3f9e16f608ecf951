// SPDX-License-Identifier: BSD-3-Clause
// The links between the vehicles of a recorded run: what arrives of a sound that one of them makes.
//
// Paths are searched for every kFrame of the departure, every search anew: a cell that shares one would step.
// The gains of paths are those of a modem's band; absorption at other frequencies than its centre is that of
// the way of the first significant path, half way between the depths of the ends.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
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

// A link whose paths are searched as time goes on (ScenarioLinks::extend).
struct LinkProgress {
  std::string from;
  acoustics::Modem modem;
  std::string to;
  double begin_s;
  // So far.
  int frames = 0;
  double delay_s = -1;                         // of the last frame; below 0 of none
  std::vector<acoustics::PathGain> last = {};  // of the last frame
  double sum_length_m = 0, sum_depth_m = 0;
  // The departure up to which its paths are known.
  double end_s() const { return begin_s + kFrame.seconds() * std::max(frames - 1, 0); }
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
  // The next so many frames, with what they begin at: the same paths as between() finds, however they are
  // taken. Of states that the run holds by now.
  Way extend(LinkProgress& progress, int frames);
  // A filter of linear phase: what absorption takes of a frequency beyond what it takes of the band's centre,
  // in the water at that instant. Nothing above `highest_hz` passes.
  std::vector<double> absorption_taps(const Way& way, SimTime at, double rate_hz,
                                      double highest_hz = std::numeric_limits<double>::infinity()) const;
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

  std::vector<acoustics::PathGain> next_frame(LinkProgress& progress, const VehicleTrack& sender,
                                              const VehicleTrack& receiver);
  channel_server::Reception reception_of(SimTime departure, const End& from, End to,
                                         const VehicleTrack& receiver, double& delay_s);

  ScenarioConfig config_;
  const Recording& run_;
  channel_server::ConfiguredModems modems_;
  const bathymetry::Terrain& terrain_;
  channel_server::WaterModel water_;
};

}  // namespace halocline::clients
