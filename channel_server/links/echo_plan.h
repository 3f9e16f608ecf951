// SPDX-License-Identifier: BSD-3-Clause
// Which pairs of vehicles have their bottom echoes surveyed after the tables of a tick, where there are more
// than may be.
//
// Rule. A pair needs a survey when it has none, or when an end lies further than `reuse_distance` from where
// it was at the last one. Of those that need one as many are planned as a table may have: those without any
// first, then those planned longest ago; equals by id.
//
// What is planned is a function of the links of all ticks since the start of the run, of all vehicles,
// whichever shard serves them, and of surveys that had no answer: shards and processes agree. A server that
// was started again plans anew. Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "channel_server/propagation/propagation.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/frames.h"

namespace halocline::channel_server {

struct EchoRule {
  double reuse_distance_m = 5;           // 0 and up; 0 surveys anew whatever moved at all
  std::size_t surveys_per_table = 2400;  // 1 and up
};

struct PlannedSurvey {
  VehiclePair pair;            // the lower id first
  Vec3 low_ned_m, high_ned_m;  // where they are
};

class EchoPlan {
 public:
  explicit EchoPlan(EchoRule rule) : rule_(rule) {}

  // All links of all vehicles at a tick; pairs without one are forgotten. The most urgent survey first.
  std::vector<PlannedSurvey> begin_tick(const std::vector<EndPair>& links);
  // What was planned for the pair was dropped or had no answer: it needs another.
  void note_unanswered(const VehiclePair& pair);
  // Pairs that needed a survey at the last tick and were not planned.
  std::size_t put_off() const { return put_off_; }
  void clear();

 private:
  struct Entry {
    PlannedSurvey last;        // its places: of the last survey that was planned
    std::int64_t planned = 0;  // the number of its tick, from 1; 0: never
    bool is_answered = false;  // or still may be
  };
  Entry* find(const VehiclePair& pair);

  EchoRule rule_;
  std::int64_t tick_ = 0;
  std::vector<Entry> entries_;  // by pair, rising
  std::size_t put_off_ = 0;
};

}  // namespace halocline::channel_server
