// SPDX-License-Identifier: BSD-3-Clause
// Rows of link tables that hold on from tick to tick while their ends hardly move.
//
// Rule. A row is carried on, instead of computed anew, for kLongest at most, as long as its ends together
// have moved by no more than the distance of reuse d, nor a fortieth of the range (depths count ten times),
// each velocity has changed by no more than kGreatestVelocityChange, and water, seabed and both modems are
// the same. Then range and Doppler are those of the ends now, and a delay along a path that leaves the
// transmitter at the angle a below the horizontal and arrives at the angle b is
//   tau = tau_then + (cos a dr - sin a dz_transmitter) / c_transmitter + sin b dz_receiver / c_receiver,
// r the horizontal range and z depths (Fermat's principle; acoustics/rays/extrapolate_arrivals.h takes whole
// paths on likewise). Levels and what is delivered stay: spreading changes by 0.2 dB at most meanwhile.
// LinkRow::paths_age grows.
//
// A row that waits for a search or for the bottom is not kept. What is kept depends on the ticks since the
// start: threads and shards agree, a server that was started again computes all rows anew. Not thread-safe.
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

class KeptRows {
 public:
  static constexpr SimDuration kLongest = SimDuration::from_milliseconds(10'000);  // our choice
  static constexpr double kGreatestVelocityChange = 0.5;                           // m/s, our choice
  // Where sound goes: other numbers, another sea.
  struct Sea {
    EnvironmentTimeline::WaterId water_id = 0;
    std::int64_t seabed_version = 0;
    bool operator==(const Sea&) const = default;
  };

  // `reuse_distance_m`: d, 0..1000; 0 keeps nothing.
  explicit KeptRows(double reuse_distance_m);

  // The links of a tick, which come after those of the ticks before, transmitter by transmitter and each by
  // receiver, as table_rows() has them; `vehicles` holds their ends, by id. Sets TableRows::carried, without
  // the ages of states. The same again for the same tick.
  void carry_on(SimTime tick, Sea sea, const acoustics::Environment& environment,
                const std::vector<PlacedVehicle>& vehicles, TableRows& rows);
  // Computed for link `index` of that tick.
  void keep(std::size_t index, const EndPair& ends, const Reception& reception, const LinkRow& row);
  void clear();

 private:
  // Of a path where it leaves and arrives.
  struct Angles {
    double launch_rad = 0, arrival_rad = 0;
  };
  struct Kept {
    VehicleId from = 0, to = 0;
    SimTime made_at;
    Vec3 from_ned_m, from_mps, to_ned_m, to_mps;
    Angles strongest, first;  // whose delays the row has
    LinkRow row;
  };
  struct KnownModem {
    acoustics::Modem modem;
    SimTime since;
  };

  void know_modems(const std::vector<PlacedVehicle>& vehicles);
  bool holds(const Kept& kept, const EndPair& now) const;
  static LinkRow carried(const Kept& kept, const EndPair& now, SimTime tick,
                         const acoustics::Environment& environment);

  double reuse_distance_m_;
  SimTime tick_;
  Sea sea_;
  std::map<VehicleId, KnownModem> modems_;
  std::vector<std::optional<Kept>> rows_;  // of the last tick's links
};

}  // namespace halocline::channel_server
