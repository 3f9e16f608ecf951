// SPDX-License-Identifier: BSD-3-Clause
// What is known of the bottom echoes between vehicles, and which of it the next link table may use.
//
// Rule. The row of tick k holds the echoes of the geometry of tick k-1: its answer has had a whole period to
// arrive, so a table never waits, and a replay gives the same tables. A survey serves as long as both ends
// (at tick k-1) lie within `reuse_distance` of where they were when it was queried; without one the row holds
// unknown. One survey serves both directions. Which pairs are surveyed: echo_plan.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "acoustics/modem/modem.h"
#include "channel_server/links/echo_survey.h"
#include "channel_server/links/link_table.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/vehicles/shard.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

class MultipathCache {
 public:
  // m, 0 and up; 0 queries anew whatever moved at all.
  explicit MultipathCache(double reuse_distance_m) : reuse_distance_m_(reuse_distance_m) {}

  // For the row of the next tick, from the geometry of the last begin_tick(), in the water of `at`.
  Multipath at_last_tick(SimTime at, const PlacedVehicle& transmitter, const PlacedVehicle& receiver,
                         Propagation& propagation);
  // For two places given; unknown where no survey of the pair serves them.
  Multipath at(SimTime at, const PlacedVehicle& transmitter, const PlacedVehicle& receiver,
               Propagation& propagation);

  // The tables of a tick are made; its geometry is this.
  void begin_tick(const std::vector<PlacedVehicle>& vehicles);
  // The survey's `from` is the lower id. Of vehicles that are not present it is not kept.
  void store(const VehiclePair& pair, EchoSurvey survey);

  // The water is another from now on: verdicts are computed anew.
  void forget_verdicts();
  void clear();
  std::size_t surveys_kept() const { return entries_.size(); }

 private:
  struct Verdict {
    acoustics::Modem transmitter, receiver;
    Multipath multipath = Multipath::kUnknown;
    bool known = false;
  };
  struct Entry {
    EchoSurvey survey;
    Verdict verdicts[2];  // from the lower id, from the higher
  };
  bool serves(const Entry& entry, const Vec3& low, const Vec3& high) const;
  Multipath verdict_of(Entry& entry, SimTime at, const PlacedVehicle& transmitter,
                       const PlacedVehicle& receiver, Propagation& propagation);
  Multipath look_up(SimTime at, const PlacedVehicle& transmitter, const PlacedVehicle& receiver,
                    const Vec3& from, const Vec3& to, Propagation& propagation);

  double reuse_distance_m_;
  struct PairHash {
    std::size_t operator()(const VehiclePair& pair) const {
      return std::hash<std::uint64_t>()(static_cast<std::uint64_t>(pair.first) << 32 |
                                        static_cast<std::uint32_t>(pair.second));
    }
  };
  std::unordered_map<VehicleId, Vec3> places_;
  std::unordered_map<VehiclePair, Entry, PairHash> entries_;
};

}  // namespace halocline::channel_server
