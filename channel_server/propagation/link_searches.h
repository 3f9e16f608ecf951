// SPDX-License-Identifier: BSD-3-Clause
// Searches for the eigenrays of links: which query (path_search.h) belongs to a link, what has been found for
// it, and what must be searched now.
//
// A link is searched from the end where its bottom profile starts (the lower id) to the other end.
//
// - Reception of one link: the query of its exact ends.
// - Link table: the query of the link's cell (path_reuse.h) or, with a limited number of searches a tick
//   (search_scheduler.h), the query of the link that was scheduled last.
// - Packet: the query of the link's exact ends or, with RayModel::reuse_for_packets, that of a link table. In
//   the second case a link that has not been scheduled yet, or was scheduled in other water or over another
//   seabed, is searched at once.
//
// Results are kept for kKept after their last use and searched again after that. Answers are functions of
// environment, terrain and query alone, and of the ticks so far where searches are limited. Of several
// channel servers, one searches for the link of two vehicles (path_exchange.h). Not thread-safe.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "acoustics/link/link_kernel.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/ray_water.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/path_exchange.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/propagation/seabed_profile.h"
#include "channel_server/propagation/search_scheduler.h"
#include "channel_server/propagation/straight_propagation.h"
#include "core/for_each.h"
#include "core/lru_cache.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

class LinkSearches {
 public:
  using Paths = std::shared_ptr<const SearchResult>;
  // Simulation time for which an unused result is kept, and at most twice that. Vehicles that lie still or
  // soon pass a cell again reuse it, and memory is bounded by four minutes of results however long the run.
  static constexpr SimDuration kKept = SimDuration::from_milliseconds(120'000);
  // Link that is ready to be searched without access to the caches.
  struct Task {
    EndPair ends;
    const acoustics::Environment* environment;
    std::shared_ptr<const acoustics::RayWater> water;
    std::shared_ptr<const acoustics::LinkKernel> kernel;
    PathQuery query;
    acoustics::RayLink link;  // geometry of the ends; differs from the query's when paths are extrapolated
    bool reversed = false;    // the transmitter is the profile's last end
    bool shared = false;      // the query serves other links too
    bool of_table = false;    // query of link tables, which the server of the other end makes too
    SearchScheduler::Scheduled* scheduled =
        nullptr;           // null without a limit, and before the link is scheduled first
    bool waits = false;    // the link has not been scheduled yet
    SimDuration age = {};  // since the scheduled query was the link's own
  };

  // Throws InvalidArgument when the model is out of range. `straight` must outlive the searches.
  LinkSearches(std::shared_ptr<const EnvironmentTimeline> waters, std::shared_ptr<SeabedMap> seabed,
               const RayModel& model, StraightPropagation& straight);

  Task for_itself(SimTime at, const LinkEnd& from, const LinkEnd& to) {
    return task_of(at, from, to, from.id > to.id);
  }
  // Returns a task for the link itself over a given bottom that runs from the transmitter to the receiver.
  Task over(SimTime at, const LinkEnd& from, const LinkEnd& to,
            const std::shared_ptr<const SeabedProfile>& seabed);
  Task for_table(SimTime at, const LinkEnd& from, const LinkEnd& to);
  Task for_packet(SimTime at, const LinkEnd& from, const LinkEnd& to);

  // Exchanges results with other servers from now on; `exchange` must outlive the searches.
  void share_through(PathExchange& exchange) { exchange_ = &exchange; }

  bool has_scheduler() const { return scheduler_.has_value(); }
  // See Propagation::begin_tick.
  void begin_tick(SimTime at, const std::vector<EndPair>& all);

  // True when find() has the seabed that it needs. What is missing is requested.
  bool is_ready(const Task& task);
  // See is_ready(), here for the queries that links of a table may be scheduled with at the next tick.
  bool are_ready_for_table(SimTime at, const std::vector<EndPair>& links);

  // Returns the paths of a task, searched for if necessary; null where the bottom is unknown.
  Paths find(const Task& task);
  // Searches over a given bottom, with other tasks of one line if `line` is not null; the result is not kept.
  Paths find(const Task& task, SharedLine* line) const {
    if (line == nullptr)
      return search_paths(model_, *task.water, *task.environment, task.query, *task.query.given);
    return line->line.search(model_, *task.water, *task.environment, task.query, *task.query.given,
                             line->rays.get());
  }
  // Returns the paths of each task, in their order; null for tasks that are not scheduled yet.
  std::vector<Paths> find_all(const std::vector<Task>& tasks, const ForEach& for_each);

  // Handles the links of a table that this server shares with another: searches for those it owns and awaits
  // the results of those that the other owns.
  void find_shared(SimTime at, const std::vector<EndPair>& links, const ForEach& for_each);

  std::shared_ptr<const SeabedProfile> seabed_of(const PathQuery& query) const;
  std::int64_t searches() const { return searches_; }  // since the start

 private:
  using Cache = LruCache<PathQuery::Key, Paths, PathQuery::KeyHash>;

  std::shared_ptr<const acoustics::RayWater> water_of(SimTime at, double frequency_hz);
  Task task_of(SimTime at, const LinkEnd& from, const LinkEnd& to, bool reversed);
  void forget_unused(SimTime at);
  Task shared_task_of(SimTime at, const LinkEnd& from, const LinkEnd& to);
  // Returns the task of a table whose link has the query of `now` at this instant.
  Task scheduled_task(SimTime at, Task now);
  Cache& cache_of(const Task& task) { return task.shared ? shared_ : own_; }
  // Returns the paths that are cached or received; null when there are none yet.
  Paths known(const Task& task);
  // Data that tasks along one line share.
  struct Line {
    std::optional<std::shared_ptr<const SeabedProfile>> seabed = std::nullopt;  // empty: not looked up yet
    PathLine searches = {};
  };
  // Searches for the paths of a task; null where the bottom is unknown. Calls may overlap between threads,
  // each with lines of its own.
  Paths search(const Task& task, Line& line) const;
  void keep(const Task& task, const Paths& paths);
  // True when the server of the other end uses the same paths.
  bool is_shared(const Task& task) const;

  std::shared_ptr<const EnvironmentTimeline> waters_;
  std::shared_ptr<SeabedMap> seabed_;
  RayModel model_;
  StraightPropagation& straight_;
  LruCache<std::pair<EnvironmentTimeline::WaterId, double>, std::shared_ptr<const acoustics::RayWater>>
      ray_waters_;
  Cache own_, shared_;
  SimTime next_forgetting_ = SimTime() + kKept;
  std::optional<SearchScheduler> scheduler_;
  PathExchange* exchange_ = nullptr;  // null: the only server
  std::int64_t searches_ = 0;
};

}  // namespace halocline::channel_server
