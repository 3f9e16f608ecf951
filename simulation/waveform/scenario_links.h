// SPDX-License-Identifier: BSD-3-Clause
// Links between the vehicles of a recorded run: propagation of a sound from one vehicle to another.
//
// Paths are searched for every kFrame of the departure, with a search of its own for each frame: results
// shared within a cell of positions would change in steps. The gains of paths are those in a modem's band.
// Absorption at frequencies other than the band's centre is computed for the length of the first significant
// path, at the mean depth of the ends.
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
#include "core/sim_time.h"
#include "core/units.h"
#include "runs/analysis/recording.h"
#include "simulation/composition.h"
#include "simulation/vehicle_track.h"

namespace halocline::clients {

inline constexpr SimDuration kFrame = SimDuration::from_milliseconds(20);

// Converts a level re 1 uPa to an amplitude in uPa, or any level difference to a ratio of amplitudes.
double amplitude_of(Decibels level);

// Propagation from a vehicle with a given modem to another.
struct Way {
  acoustics::MovingLink link;
  double length_m, depth_m;  // means over the time of departure
  double centre_hz;
};

// State of a link whose paths are searched as time goes on (ScenarioLinks::extend).
struct LinkProgress {
  std::string from;
  acoustics::Modem modem;
  std::string to;
  double begin_s;
  // Results so far.
  int frames = 0;
  double delay_s = -1;                         // last frame's delay; below 0: none yet
  std::vector<acoustics::PathGain> last = {};  // gains in the last frame
  double sum_length_m = 0, sum_depth_m = 0;
  // Returns the departure up to which paths are known, s.
  double end_s() const { return begin_s + kFrame.seconds() * std::max(frames - 1, 0); }
};

// Propagation between vehicles of a run.
class ScenarioLinks {
 public:
  // The arguments except `config` must outlive this.
  ScenarioLinks(const ScenarioConfig& config, const bathymetry::Terrain& terrain, const Recording& run);

  const acoustics::Environment& water(SimTime at) const { return water_.propagation->environment(at); }
  // Returns the id of a vehicle. Throws InvalidArgument when it does not exist.
  std::int32_t id_of(const std::string& vehicle) const;
  const acoustics::Modem& modem_of(const std::string& vehicle) const { return modems_.of(vehicle).modem; }

  // Returns the propagation of sound that departs between those times.
  Way between(const std::string& from, const acoustics::Modem& sender, const std::string& to, double begin_s,
              double end_s);
  // Computes the next `frames` frames and returns them with the frame at which they begin. The paths are
  // those that between() finds, for any division into calls. Only states that the run holds at the time of
  // the call are used.
  Way extend(LinkProgress& progress, int frames);
  // Returns a linear-phase filter with the absorption at each frequency relative to that at the centre of the
  // band, in the water at that instant. It blocks frequencies above `highest_hz`.
  std::vector<double> absorption_taps(const Way& way, SimTime at, double rate_hz,
                                      double highest_hz = std::numeric_limits<double>::infinity()) const;
  // Adds the received part of a sound, which is given as pressure at 1 m.
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
