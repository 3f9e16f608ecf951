// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/propagation/link_searches.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <unordered_map>

#include "acoustics/rays/search/eigenray_search.h"
#include "channel_server/propagation/path_reuse.h"
#include "core/elementary.h"
#include "core/frames.h"
#include "core/units.h"

namespace halocline::channel_server {
namespace {

constexpr std::size_t kMaxFound = 4096, kMaxSharedFound = 32'768;  // cached searches, 7 kB each
constexpr std::size_t kMaxRayWaters = 256;                         // limit of the cache, 20 kB each

double depth_of(const LinkEnd& end, const acoustics::Environment& environment) {
  return std::clamp(depth_below_surface_m(end.position_ned_m, environment.sea_surface_z_m), 0.0,
                    kDeepestEndM);
}

// Returns one link for each id: the two directions between a pair have the same query at one frequency.
std::vector<std::pair<SearchScheduler::LinkId, const EndPair*>> one_way_of_each(
    const std::vector<EndPair>& links) {
  std::vector<std::pair<SearchScheduler::LinkId, const EndPair*>> ways;
  for (const EndPair& link : links) ways.emplace_back(SearchScheduler::id_of(link), &link);
  std::sort(ways.begin(), ways.end());  // links of one id by address
  const auto same = [](const auto& a, const auto& b) { return a.first == b.first; };
  ways.erase(std::unique(ways.begin(), ways.end(), same), ways.end());
  return ways;
}

SharedQuery shared_query(const LinkSearches::Task& task) {
  return {task.ends.from.id, task.ends.to.id, task.query, *task.water, *task.environment};
}

}  // namespace

LinkSearches::LinkSearches(std::shared_ptr<const EnvironmentTimeline> waters,
                           std::shared_ptr<SeabedMap> seabed, const RayModel& model,
                           StraightPropagation& straight)
    : waters_(std::move(waters)),
      seabed_(std::move(seabed)),
      model_(model),
      straight_(straight),
      ray_waters_(kMaxRayWaters),
      own_(kMaxFound),
      shared_(kMaxSharedFound) {
  validate(model);
  if (model.max_searches_per_tick > 0) scheduler_.emplace(model.max_searches_per_tick);
}

std::shared_ptr<const acoustics::RayWater> LinkSearches::water_of(SimTime at, double frequency_hz) {
  return ray_waters_.find_or_make({waters_->water_at(at), frequency_hz}, [&] {
    return std::make_shared<const acoustics::RayWater>(
        ray_water(waters_->at(at), frequency_hz, model_.speed_tolerance_mps));
  });
}

void LinkSearches::forget_unused(SimTime at) {
  if (at < next_forgetting_) return;
  ray_waters_.forget_unused();
  own_.forget_unused();
  shared_.forget_unused();
  next_forgetting_ = at + kKept;
}

LinkSearches::Task LinkSearches::task_of(SimTime at, const LinkEnd& from, const LinkEnd& to, bool reversed) {
  forget_unused(at);
  const acoustics::Environment& environment = waters_->at(at);
  const LinkEnd &first = reversed ? to : from, &last = reversed ? from : to;
  const Vec3 way = last.position_ned_m - first.position_ned_m;
  const double frequency_hz = from.modem->centre_frequency_hz;
  const acoustics::RayLink link{depth_of(first, environment), depth_of(last, environment),
                                elementary::hypot(way.x(), way.y())};
  const ProfileEnds places{first.position_ned_m.x(), first.position_ned_m.y(), last.position_ned_m.x(),
                           last.position_ned_m.y()};
  const auto kernel = straight_.kernel_of(at, *from.modem, *to.modem);
  const double negligible_db = (kernel->noise_level() - to.modem->directivity_index -
                                model_.diffuse_below_noise - from.modem->source_level)
                                   .value;
  return {{from, to},
          &environment,
          water_of(at, frequency_hz),
          kernel,
          {waters_->water_at(at), frequency_hz, places, seabed_->version(), nullptr, link,
           elementary::exp10(negligible_db / 20)},
          link,
          reversed};
}

LinkSearches::Task LinkSearches::over(SimTime at, const LinkEnd& from, const LinkEnd& to,
                                      const std::shared_ptr<const SeabedProfile>& seabed) {
  Task task = task_of(at, from, to, /*reversed=*/false);
  if (!task.environment->field) task.query.places = {};
  task.query.given = seabed;
  return task;
}

LinkSearches::Task LinkSearches::shared_task_of(SimTime at, const LinkEnd& from, const LinkEnd& to) {
  Task task = task_of(at, from, to, from.id > to.id);
  task.of_table = true;
  task.shared = reuses_paths(model_);
  if (task.shared) task.query = query_of_cell(task.query, *task.water, model_.reuse_distance_m);
  return task;
}

LinkSearches::Task LinkSearches::for_table(SimTime at, const LinkEnd& from, const LinkEnd& to) {
  return scheduled_task(at, shared_task_of(at, from, to));
}

LinkSearches::Task LinkSearches::scheduled_task(SimTime at, Task task) {
  if (!scheduler_) return task;
  SearchScheduler::Scheduled* scheduled = scheduler_->find(SearchScheduler::id_of(task.ends));
  task.waits = scheduled == nullptr;
  // A query that was scheduled but not searched cannot be searched any more once its sea has changed.
  if (task.waits || (!scheduled->paths && !is_of_one_sea(scheduled->query, task.query))) return task;
  task.scheduled = scheduled;
  task.query = scheduled->query;
  task.age = at - scheduled->current_at;
  return task;
}

LinkSearches::Task LinkSearches::for_packet(SimTime at, const LinkEnd& from, const LinkEnd& to) {
  if (!model_.reuse_for_packets) return for_itself(at, from, to);
  Task now = shared_task_of(at, from, to);
  if (!scheduler_) return now;
  Task scheduled = scheduled_task(at, now);
  return scheduled.waits || !is_of_one_sea(scheduled.query, now.query) ? now : scheduled;
}

void LinkSearches::begin_tick(SimTime at, const std::vector<EndPair>& all) {
  if (!scheduler_) return;
  std::vector<SearchScheduler::Wanted> wanted;
  for (const auto& [id, link] : one_way_of_each(all)) {
    const auto& [from, to] = *link;
    Task task = shared_task_of(at, from, to);
    const double range_m =
        std::max((to.position_ned_m - from.position_ned_m).norm(), acoustics::kMinDistance);
    const Decibels level = from.modem->source_level - Decibels{20 * elementary::log10(range_m)};
    wanted.push_back({id, std::move(task.query), (level - to.modem->min_receivable_level).value});
  }
  scheduler_->begin_tick(at, std::move(wanted));
}

bool LinkSearches::is_ready(const Task& task) {
  const auto [north, east, last_north, last_east] = task.query.places;
  return known(task) || seabed_->is_surveyed({north, east, 0}, {last_north, last_east, 0});
}

// Every link is examined, so that all missing tiles are requested together.
bool LinkSearches::are_ready_for_table(SimTime at, const std::vector<EndPair>& links) {
  bool ready = true;
  for (const auto& [id, link] : one_way_of_each(links))
    ready = is_ready(shared_task_of(at, link->from, link->to)) && ready;
  return ready;
}

// The results of scheduled queries are kept for as long as they are used, although the cache may drop them.
LinkSearches::Paths LinkSearches::known(const Task& task) {
  if (task.scheduled != nullptr && task.scheduled->paths) return task.scheduled->paths;
  if (const Paths* paths = cache_of(task).find(task.query.key())) return *paths;
  if (!is_shared(task)) return nullptr;
  Paths received = exchange_->received(shared_query(task));
  return received ? cache_of(task).insert(task.query.key(), std::move(received)) : nullptr;
}

// Between modems of two kinds, each direction has a query of its own.
bool LinkSearches::is_shared(const Task& task) const {
  const auto& [from, to] = task.ends;
  return exchange_ != nullptr && task.of_table && exchange_->is_shared(from.id, to.id) &&
         (from.modem == to.modem || *from.modem == *to.modem);
}

void LinkSearches::keep(const Task& task, const Paths& paths) {
  if (!paths) return;
  ++searches_;
  cache_of(task).insert(task.query.key(), paths);
  if (is_shared(task)) exchange_->found(shared_query(task), *paths);
}

LinkSearches::Paths LinkSearches::find(const Task& task) {
  if (Paths paths = known(task)) return paths;
  Line line;
  Paths paths = search(task, line);
  keep(task, paths);
  return paths;
}

// Caches are read and written sequentially; searches are distributed.
std::vector<LinkSearches::Paths> LinkSearches::find_all(const std::vector<Task>& tasks,
                                                        const ForEach& for_each) {
  std::vector<Paths> of_queries;  // null where the bottom is unknown
  std::unordered_map<PathQuery::Key, std::size_t, PathQuery::KeyHash> place_of;  // in `of_queries`
  struct Search {
    const Task* task;
    std::size_t place;
  };
  std::vector<Search> searches;
  std::vector<std::vector<Search>> lines;  // the searches, by line
  std::map<decltype(PathQuery().line()), std::size_t> line_of;
  std::vector<std::size_t> places;  // index of each task in `of_queries`
  for (const Task& task : tasks) {
    places.push_back(of_queries.size());
    if (task.waits) continue;
    const auto [query, is_new] = place_of.emplace(task.query.key(), of_queries.size());
    places.back() = query->second;
    if (!is_new) continue;
    of_queries.push_back(known(task));
    if (of_queries.back()) continue;
    searches.push_back({&task, query->second});
    const std::size_t line = line_of.emplace(task.query.line(), lines.size()).first->second;
    if (line == lines.size()) lines.emplace_back();
    lines[line].push_back(searches.back());
  }
  for_each(lines.size(), [&](std::size_t i) {
    Line line;
    for (const Search& one : lines[i]) of_queries[one.place] = search(*one.task, line);
  });
  for (const Search& done : searches) keep(*done.task, of_queries[done.place]);
  std::vector<Paths> found;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    found.push_back(tasks[i].waits ? nullptr : of_queries[places[i]]);
    if (tasks[i].scheduled != nullptr) tasks[i].scheduled->paths = found.back();
  }
  return found;
}

void LinkSearches::find_shared(SimTime at, const std::vector<EndPair>& links, const ForEach& for_each) {
  std::vector<Task> own;
  for (const auto& [from, to] : links) {
    if (!exchange_->is_shared(from.id, to.id)) continue;
    Task task = for_table(at, from, to);
    if (!is_shared(task)) continue;
    if (exchange_->is_owner(from.id, to.id)) {
      own.push_back(std::move(task));
    } else if (!task.waits && !known(task)) {
      exchange_->await(from.id, to.id);
    }
  }
  find_all(own, for_each);
}

LinkSearches::Paths LinkSearches::search(const Task& task, Line& line) const {
  const PathQuery& query = task.query;
  if (!query.given && may_be_flux_only(model_, *task.water, query)) {
    const auto [north, east, last_north, last_east] = query.places;
    const auto places = seabed_->places_between({north, east, 0}, {last_north, last_east, 0});
    if (!places) return nullptr;
    if (auto weak = flux_only_paths(model_, *task.water, *task.environment, query, *places)) return weak;
  }
  if (!line.seabed) line.seabed = seabed_of(query);
  if (!*line.seabed) return nullptr;
  return line.searches.search(model_, *task.water, *task.environment, query, **line.seabed);
}

std::shared_ptr<const SeabedProfile> LinkSearches::seabed_of(const PathQuery& q) const {
  if (q.given) return q.given;
  return seabed_->between({q.places[0], q.places[1], 0}, {q.places[2], q.places[3], 0});
}

}  // namespace halocline::channel_server
