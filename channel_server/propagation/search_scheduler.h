// SPDX-License-Identifier: BSD-3-Clause
// Scheduler of eigenray searches for link tables: picks the links to search at a tick when more are due than
// the time of the server allows.
//
// Rule. A link is due when the query of its paths (path_search.h) differs from the one that was scheduled for
// it last. At each tick, as many of the links that are due are scheduled as the limit allows, in order of
// urgency
//
//   U = L + 20 log10(d / 25 m)
//
// where L is the received level above the receiver's least receivable level, along a straight line without
// absorption, dB, and d is how far the ends have moved since the link was scheduled last (depths count ten
// times; path_reuse.h). So the loudest and most changed links come first. Links that were never scheduled
// precede all others; links in other water or over another seabed precede those that only moved; equal
// urgencies are ordered by id. All other links keep the paths of their last search, extrapolated to the
// present ends.
//
// The schedule is a function of the links of all ticks since the start of the run, of all vehicles, whichever
// shard serves them: threads, shards and processes agree. A server that was restarted schedules afresh. Not
// thread-safe.
#pragma once

#include <cstddef>
#include <memory>
#include <tuple>
#include <vector>

#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

class SearchScheduler {
 public:
  using LinkId = std::tuple<VehicleId, VehicleId, double>;  // lower id, higher id, Hz
  // Returns the id of a link; both directions of a pair have the same paths at one frequency.
  static LinkId id_of(const EndPair& ends);
  struct Wanted {
    LinkId id;
    PathQuery query;
    double excess_db = 0;  // the L of the urgency
  };
  struct Scheduled {
    PathQuery query;
    SimTime current_at;  // latest tick at which this was the link's query
    std::shared_ptr<const SearchResult>
        paths;  // set after the search; null before, and where the bottom is unknown
  };

  // `searches` is the limit a tick, 1 or more.
  explicit SearchScheduler(int searches) : searches_(static_cast<std::size_t>(searches)) {}

  // Schedules searches among all links of all vehicles at a tick; of two links of one id, the first counts.
  // Links that are not listed are forgotten. A tick before the last one begins another run.
  void begin_tick(SimTime tick, std::vector<Wanted> links);
  // Returns the scheduled query of a link; null for one that was never scheduled. Valid until the next
  // begin_tick.
  Scheduled* find(const LinkId& id);

 private:
  std::size_t searches_;
  SimTime tick_;
  std::vector<LinkId> ids_;           // sorted
  std::vector<Scheduled> scheduled_;  // for each id
};

}  // namespace halocline::channel_server
