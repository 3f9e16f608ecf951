// SPDX-License-Identifier: BSD-3-Clause
// The plan of echo surveys: picks the pairs of vehicles whose bottom echoes are surveyed after the tables of
// a tick, when more need it than the budget allows.
//
// Rule. A pair needs a survey when it has none, or when an end lies further than `reuse_distance` from its
// position in the last one. Up to `surveys_per_table` of these pairs are planned: pairs without any survey
// first, then those planned longest ago, and equal ones by id.
//
// The plan depends only on the links of all ticks since the start of the run, of all vehicles whichever shard
// serves them, and on surveys without an answer. Shards and processes therefore agree. A server that is
// restarted plans from the beginning. Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "channel_server/propagation/propagation.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/frames.h"

namespace halocline::channel_server {

// The parameters of the plan.
struct EchoRule {
  double reuse_distance_m = 5;           // at least 0; with 0 a pair is surveyed again after any motion
  std::size_t surveys_per_table = 2400;  // at least 1
};

// A survey to be made: a pair of vehicles and their positions.
struct PlannedSurvey {
  VehiclePair pair;            // the lower id first
  Vec3 low_ned_m, high_ned_m;  // positions of both vehicles
};

class EchoPlan {
 public:
  explicit EchoPlan(EchoRule rule) : rule_(rule) {}

  // Plans the surveys of a tick from all links of all vehicles, and returns them by urgency. Pairs without a
  // link are forgotten.
  std::vector<PlannedSurvey> begin_tick(const std::vector<EndPair>& links);
  // Notes that the planned survey of a pair was dropped or had no answer, so the pair needs another.
  void note_unanswered(const VehiclePair& pair);
  // Returns the number of pairs that needed a survey at the last tick and were not planned.
  std::size_t deferred() const { return deferred_; }
  void clear();

 private:
  struct Entry {
    PlannedSurvey last;        // the last planned survey
    std::int64_t planned = 0;  // number of the tick at which it was planned, from 1; 0 for never
    bool is_answered = false;  // answered, or the answer may still come
  };
  Entry* find(const VehiclePair& pair);

  EchoRule rule_;
  std::int64_t tick_ = 0;
  std::vector<Entry> entries_;  // sorted by pair
  std::size_t deferred_ = 0;
};

}  // namespace halocline::channel_server
