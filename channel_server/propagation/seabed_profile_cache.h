// The bottom profiles between vehicles, and which of them holds when.
//
// Rule. What is queried for the geometry of tick k-1 serves the rows of tick k and all sound that leaves in
// [tick k, tick k+1): its answer has had a whole period to arrive, so nothing ever waits, and a replay uses the same
// profiles. The profile of a pair is kept as long as both vehicles stay in their lattice cells
// (profile_survey.h); once one is in another cell at a tick, the pair has no profile (the bottom is unknown)
// unless that of the new cells was answered in time. One profile serves both directions.
//
// Sound on its way needs the instant at which it left: what held is kept until forgotten. Not thread-safe.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "channel_server/propagation/profile_survey.h"
#include "channel_server/vehicles/shard.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

class SeabedProfileCache {
 public:
  explicit SeabedProfileCache(const ProfileRule& rule) : rule_(rule) {}

  // From `tick` on hold the profiles of the last geometry, as far as they are known. Instants rise.
  void open_tick(SimTime tick);
  // The geometry of the tick just opened. Returns the pairs whose cells have no answer yet,
  // those queried longest ago first.
  std::vector<VehiclePair> take_geometry(const std::vector<PlacedVehicle>& vehicles, Shard shard = {});

  // Of a pair of the last geometry; it runs from the lower id to the higher.
  ProfileSurvey survey_of(const VehiclePair& pair) const;
  // The pair was queried, with or without an answer.
  void note_queried(const VehiclePair& pair);
  // An answer for cells that the pair has left meanwhile is of no use.
  void store(const VehiclePair& pair, const ProfileSurvey& survey);

  // What holds at `at` between two vehicles, from the lower id to the higher; null when unknown.
  std::shared_ptr<const SeabedProfile> at(SimTime at, const VehiclePair& pair) const;

  // Forgets what no instant at or after `time` can need.
  void forget_before(SimTime time);
  // Another run, or another terrain: forgets everything.
  void clear();

  const ProfileRule& rule() const { return rule_; }

 private:
  struct Held {
    SimTime from;
    std::shared_ptr<const SeabedProfile> profile;  // null: unknown
  };
  struct Entry {
    bool present = false;  // both were at the last tick
    CellPair cells;        // at the last tick
    bool answered = false;
    CellPair answered_cells;
    std::shared_ptr<const SeabedProfile> profile;  // of answered_cells; null where the terrain does not reach
    std::int64_t queried_at_tick = -1;
    std::vector<Held> held;  // ascending, each unlike the one before
    bool serves() const { return present && answered && answered_cells == cells; }
  };

  ProfileRule rule_;
  std::int64_t tick_ = 0;
  std::map<VehiclePair, Entry> entries_;
};

}  // namespace halocline::channel_server
