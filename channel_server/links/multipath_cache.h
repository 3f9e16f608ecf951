// SPDX-License-Identifier: BSD-3-Clause
// A cache of echo surveys between pairs of vehicles, and of the verdicts whether a bottom echo is likely, for
// the next link table.
//
// Rule. The row of tick k states the echoes for the geometry of tick k-1. The survey of that geometry has had
// a whole period to arrive, so a table never waits, and a replay gives the same tables. A survey is used as
// long as both ends (at tick k-1) lie within `reuse_distance` of the positions that it was made for; without
// such a survey the row holds kUnknown. One survey serves both directions of a link. echo_plan.h decides
// which pairs are surveyed.
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
  // `reuse_distance_m` is at least 0; with 0 a pair is surveyed again after any motion.
  explicit MultipathCache(double reuse_distance_m) : reuse_distance_m_(reuse_distance_m) {}

  // Returns the verdict for a row of the next tick, from the geometry of the last begin_tick(), in the water
  // at `at`.
  Multipath at_last_tick(SimTime at, const PlacedVehicle& transmitter, const PlacedVehicle& receiver,
                         Propagation& propagation);
  // Returns the verdict for the given positions of both vehicles; kUnknown when no survey of the pair is near
  // enough.
  Multipath at(SimTime at, const PlacedVehicle& transmitter, const PlacedVehicle& receiver,
               Propagation& propagation);

  // Stores the positions of a tick, after its tables have been made, and drops the surveys of vehicles that
  // have left.
  void begin_tick(const std::vector<PlacedVehicle>& vehicles);
  // Stores a survey whose `from` is the vehicle of the lower id. It is dropped when a vehicle of the pair is
  // not present.
  void store(const VehiclePair& pair, EchoSurvey survey);

  // Drops all verdicts, because the water has changed; surveys stay.
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
    Verdict verdicts[2];  // sound from the lower id, and from the higher
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
