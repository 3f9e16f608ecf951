// SPDX-License-Identifier: BSD-3-Clause
// Which links of the tables are searched for paths at a tick, where there are more than the server may take
// time for.
//
// Rule. A link needs a search when the query of its paths (path_search.h) is another than the one it was last
// granted. Of those that need one as many are granted at a tick as the budget has, by urgency
//   U = L + 20 log10(d / 25 m),
// L the received level over the receiver's least one along a straight line without absorption, dB, d how far
// the ends have moved since the link was granted a search (depths count ten times; path_search.h): the most
// audible and most changed first. A link without any search comes before all others, one in other water or
// over another seabed before those that only moved; equals by id. The rest keeps the paths of its last
// search, extrapolated to where the ends are.
//
// What is granted is a function of the links of all ticks since the start of the run, of all vehicles,
// whichever shard serves them: threads, shards and processes agree. A server that was started again grants
// anew. Not thread-safe.
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

class SearchBudget {
 public:
  using LinkId = std::tuple<VehicleId, VehicleId, double>;  // lower, higher, Hz
  // Both ways of a pair have the same paths at one frequency.
  static LinkId id_of(const EndPair& ends);
  struct Wanted {
    LinkId id;
    PathQuery query;
    double excess_db = 0;  // L
  };
  struct Granted {
    PathQuery query;
    SimTime current_at;  // the latest tick at which this was the link's query
    std::shared_ptr<const FoundPaths>
        paths;  // once they are searched for; null before, and where the bottom is unknown
  };

  // 1 or more a tick.
  explicit SearchBudget(int searches) : searches_(static_cast<std::size_t>(searches)) {}

  // All links of all vehicles at a tick; of two of one id the first. Others are forgotten. A tick before the
  // last one begins another run.
  void begin_tick(SimTime tick, std::vector<Wanted> links);
  // Null for a link that has not had its turn. Valid until the next begin_tick.
  Granted* find(const LinkId& id);

 private:
  std::size_t searches_;
  SimTime tick_;
  std::vector<LinkId> ids_;       // rising
  std::vector<Granted> granted_;  // to each
};

}  // namespace halocline::channel_server
