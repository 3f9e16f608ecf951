// SPDX-License-Identifier: BSD-3-Clause
// A cache of rows of link tables, which are reused from tick to tick while their ends hardly move.
//
// Rule. A row is reused for at most kLongest, as long as its two ends together have moved by no more than the
// reuse distance d and no more than a fortieth of the range (depths count ten times), each velocity has
// changed by no more than kMaxVelocityChange, and water, seabed and both modems are the same. Range and
// Doppler factor are recomputed for the present positions and velocities. The delay along a path that leaves
// the transmitter at the angle a below the horizontal and arrives at the angle b is extrapolated by Fermat's
// principle,
//   tau = tau_then + (cos a dr - sin a dz_transmitter) / c_transmitter + sin b dz_receiver / c_receiver,
// with the horizontal range r, depths z and sound speeds c; d marks changes since the row was computed.
// (acoustics/rays/extrapolate_eigenrays.h extrapolates whole paths by the same principle.) Levels and
// delivery stay as they were: spreading changes by at most 0.2 dB. LinkRow::paths_age grows.
//
// A row that waits for a search or for the seabed is not stored. The cache depends on all ticks since the
// start, so threads and shards agree; a server that is restarted computes all rows again. Not thread-safe.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "acoustics/modem/modem.h"
#include "acoustics/sea/environment.h"
#include "channel_server/links/link_table.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

class LinkRowCache {
 public:
  static constexpr SimDuration kLongest = SimDuration::from_milliseconds(10'000);  // a chosen value
  static constexpr double kMaxVelocityChange = 0.5;                                // m/s, a chosen value
  // The identity of water and seabed; rows are reused only while both are the same.
  struct Sea {
    EnvironmentTimeline::WaterId water_id = 0;
    std::int64_t seabed_version = 0;
    bool operator==(const Sea&) const = default;
  };

  // `reuse_distance_m` is d, 0..1000 m; with 0 no rows are reused. Throws beyond that range.
  explicit LinkRowCache(double reuse_distance_m);

  // Sets TableRows::reused for the links of a tick, without the ages of states. Ticks must come in order,
  // and links sorted by transmitter, then receiver, as table_rows() returns them; `vehicles` holds their
  // ends, by id. A repeated call for the same tick gives the same result.
  void reuse(SimTime tick, Sea sea, const acoustics::Environment& environment,
             const std::vector<PlacedVehicle>& vehicles, TableRows& rows);
  // Stores the row computed for link `index` of that tick.
  void keep(std::size_t index, const EndPair& ends, const Reception& reception, const LinkRow& row);
  void clear();

 private:
  // The angles of a path at its two ends, positive down.
  struct Angles {
    double launch_rad = 0, arrival_rad = 0;
  };
  struct Kept {
    VehicleId from = 0, to = 0;
    SimTime made_at;
    Vec3 from_ned_m, from_mps, to_ned_m, to_mps;
    Angles strongest, first;  // the paths whose delays the row states
    LinkRow row;
  };
  struct KnownModem {
    acoustics::Modem modem;
    SimTime since;
  };

  void know_modems(const std::vector<PlacedVehicle>& vehicles);
  bool holds(const Kept& kept, const EndPair& now) const;
  static LinkRow reused(const Kept& kept, const EndPair& now, SimTime tick,
                        const acoustics::Environment& environment);

  double reuse_distance_m_;
  SimTime tick_;
  Sea sea_;
  std::map<VehicleId, KnownModem> modems_;
  std::vector<std::optional<Kept>> rows_;  // one for each link of the last tick
};

}  // namespace halocline::channel_server
