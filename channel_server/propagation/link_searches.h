// SPDX-License-Identifier: BSD-3-Clause
// The searches that links need: which query of path_search.h is a link's, what has been found for it, and
// what is searched now.
//
// A link is searched from the end where the bottom profile starts (the lower id) to the other. For itself,
// the query is that of its very ends. For a table, with a distance of reuse, both ends go to the nearest
// points of a horizontal lattice for the bottom, and the query is that of the middle of the cell that the
// link lies in (middle_of_cell), but for an end exactly at a knot of the water, which keeps its depth; not
// for coherent levels. With a budget
// of searches a tick (search_budget.h) it is the query that the link was last granted. For a packet it is as
// for a table with RayModel::reuse_for_packets, but a link that waits for its first turn, or was granted its
// query in other water or over another seabed, is searched at once; else as for itself.
//
// What is found is kept for kKept after its last use, and searched again when it was forgotten: answers are
// functions of environment, terrain and query alone, and of the ticks so far where there is a budget. Of
// several servers one searches for two vehicles (path_exchange.h). Not thread-safe.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "acoustics/link/link_kernel.h"
#include "acoustics/rays/arrivals.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/ray_water.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/path_exchange.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/propagation/seabed_profile.h"
#include "channel_server/propagation/search_budget.h"
#include "channel_server/propagation/straight_propagation.h"
#include "core/for_each.h"
#include "core/lru_cache.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

class LinkSearches {
 public:
  using Paths = std::shared_ptr<const FoundPaths>;
  // Simulation time, twice that at most: vehicles that lie still or pass a cell again soon find it, and what
  // is kept is that of four minutes, however long the run.
  static constexpr SimDuration kKept = SimDuration::from_milliseconds(120'000);
  // A link, ready to be searched without touching what is kept.
  struct Task {
    EndPair ends;
    const acoustics::Environment* environment;
    std::shared_ptr<const acoustics::RayWater> water;
    std::shared_ptr<const acoustics::LinkKernel> kernel;
    PathQuery query;
    acoustics::RayLink link;  // where the ends are; the query's own unless its paths are extrapolated
    bool reversed = false;    // the transmitter is the profile's last end
    bool shared = false;      // the query serves other links, too
    bool of_table = false;    // a query of link tables, which the server of the other end makes as well
    SearchBudget::Granted* granted = nullptr;  // null without a budget, and before the link's first turn
    bool waits = false;                        // for that turn
    SimDuration age = {};                      // since the query was the link's own
  };

  // Throws InvalidArgument when the model is out of range. `straight` must outlive the searches.
  LinkSearches(std::shared_ptr<const EnvironmentTimeline> waters, std::shared_ptr<SeabedMap> seabed,
               const RayModel& model, StraightPropagation& straight);

  Task for_itself(SimTime at, const LinkEnd& from, const LinkEnd& to) {
    return task_of(at, from, to, from.id > to.id);
  }
  // Over a bottom that is given, from the one end to the other.
  Task over(SimTime at, const LinkEnd& from, const LinkEnd& to,
            const std::shared_ptr<const SeabedProfile>& seabed);
  Task for_table(SimTime at, const LinkEnd& from, const LinkEnd& to);
  Task for_packet(SimTime at, const LinkEnd& from, const LinkEnd& to);

  // From now on; it must outlive the searches.
  void share_through(PathExchange& exchange) { exchange_ = &exchange; }

  bool has_budget() const { return budget_.has_value(); }
  // As Propagation::begin_tick.
  void begin_tick(SimTime at, const std::vector<EndPair>& all);

  // Whether find() has what it needs. What it has not is requested.
  bool is_ready(const Task& task);
  // The same of the queries that links of a table may be granted at the next tick.
  bool are_ready_for_table(SimTime at, const std::vector<EndPair>& links);

  // Null where the bottom is not known.
  Paths find(const Task& task);
  // Over a bottom that is given, with other tasks of one line if there is one; nothing is kept.
  Paths find(const Task& task, SharedLine* line) const {
    if (line == nullptr)
      return search_paths(model_, *task.water, *task.environment, task.query, *task.query.given);
    return line->line.search(model_, *task.water, *task.environment, task.query, *task.query.given,
                             line->rays.get());
  }
  // Of each task, in their order; those that wait find nothing.
  std::vector<Paths> find_all(const std::vector<Task>& tasks, const ForEach& for_each);

  // Of the links of a table, those that this server and another share: what it owns is searched for, what the
  // other owns awaited.
  void find_shared(SimTime at, const std::vector<EndPair>& links, const ForEach& for_each);

  std::shared_ptr<const SeabedProfile> seabed_of(const PathQuery& query) const;
  std::int64_t searches() const { return searches_; }  // since the start

 private:
  using Cache = LruCache<PathQuery::Key, Paths, PathQuery::KeyHash>;

  std::shared_ptr<const acoustics::RayWater> water_of(SimTime at, double frequency_hz);
  Task task_of(SimTime at, const LinkEnd& from, const LinkEnd& to, bool reversed);
  void forget_unused(SimTime at);
  Task shared_task_of(SimTime at, const LinkEnd& from, const LinkEnd& to);
  // The task of a table where its own query is `now`.
  Task granted_task(SimTime at, Task now);
  Cache& cache_of(const Task& task) { return task.shared ? shared_ : own_; }
  // Null where nothing is known yet.
  Paths known(const Task& task);
  // What tasks of one line share.
  struct Line {
    std::optional<std::shared_ptr<const SeabedProfile>> seabed = std::nullopt;  // empty: not looked up yet
    PathLine searches = {};
  };
  // Null where the bottom is not known. Calls may overlap between threads, each of which has lines of its
  // own.
  Paths search(const Task& task, Line& line) const;
  void keep(const Task& task, const Paths& paths);
  // The same paths serve the server of the other end.
  bool is_shared(const Task& task) const;

  std::shared_ptr<const EnvironmentTimeline> waters_;
  std::shared_ptr<SeabedMap> seabed_;
  RayModel model_;
  StraightPropagation& straight_;
  LruCache<std::pair<EnvironmentTimeline::WaterId, double>, std::shared_ptr<const acoustics::RayWater>>
      ray_waters_;
  Cache own_, shared_;
  SimTime next_forgetting_ = SimTime() + kKept;
  std::optional<SearchBudget> budget_;
  PathExchange* exchange_ = nullptr;  // of a server that is alone
  std::int64_t searches_ = 0;
};

}  // namespace halocline::channel_server
