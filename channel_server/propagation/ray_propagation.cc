#include "channel_server/propagation/ray_propagation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "acoustics/fading/link_fading.h"
#include "acoustics/fading/scattering_loss.h"
#include "acoustics/link/extrapolate_arrivals.h"
#include "acoustics/link/link_budget.h"
#include "acoustics/link/link_kernel.h"
#include "acoustics/link/received_field.h"
#include "acoustics/rays/arc_tracer.h"
#include "acoustics/reception/guard_window.h"
#include "acoustics/sea/bottom_profile.h"
#include "channel_server/propagation/link_tracks.h"
#include "channel_server/propagation/ray_limits.h"
#include "channel_server/propagation/ray_tracks.h"
#include "channel_server/propagation/received_path.h"
#include "core/elementary.h"

namespace halocline::channel_server {
namespace {

constexpr std::size_t kMaxFound = 4096, kMaxSharedFound = 32'768;  // searches, 7 kB each
constexpr std::size_t kMaxRayWaters = 256;                         // 20 kB each
constexpr double kDeepestEndM = acoustics::kDeepestWater - 1;      // there has to be bottom below it

double depth_of(const LinkEnd& end, const acoustics::Environment& environment) {
  return std::clamp(depth_below_surface_m(end.position_ned_m, environment.sea_surface_z_m), 0.0,
                    kDeepestEndM);
}

}  // namespace

RayPropagation::RayPropagation(std::shared_ptr<const EnvironmentTimeline> waters,
                               std::shared_ptr<SeabedMap> seabed, const RayModel& model)
    : waters_(std::move(waters)),
      seabed_(std::move(seabed)),
      model_(model),
      boundaries_{model.fading, acoustics::trapped_share(model.bottom)},
      straight_(waters_, model.fading),
      ray_waters_(kMaxRayWaters),
      found_(kMaxFound),
      shared_found_(kMaxSharedFound) {
  validate(model);
  if (model.max_searches_per_tick > 0) budget_.emplace(model.max_searches_per_tick);
}

Reception RayPropagation::along_rays(SimTime at, const Task& task, FoundCache& cache) {
  const PathsPointer paths = found(task, cache);
  return paths ? answer(task, *paths)
               : straight_instead(at, task.ends, PropagationUsed::kStraightWithoutBottom, task.capacity);
}

Reception RayPropagation::reception_over(SimTime at, const LinkEnd& from, const LinkEnd& to,
                                         const std::shared_ptr<const SeabedProfile>& seabed) {
  if (!seabed) return straight_instead(at, {from, to}, PropagationUsed::kStraightWithoutBottom);
  const Task task = task_over(at, from, to, seabed);
  return answer(task, *found(task, found_));
}

acoustics::Arrivals RayPropagation::arrivals_over(SimTime at, const LinkEnd& from, const LinkEnd& to,
                                                  const std::shared_ptr<const SeabedProfile>& seabed) {
  const PathsPointer found_paths = found(task_over(at, from, to, seabed), found_);
  acoustics::Arrivals all = found_paths->arrivals;
  const acoustics::Transducers beams{from.modem->beam, to.modem->beam};
  std::erase_if(all.paths,
                [&](const acoustics::Arrival& path) { return !(weighted_pressure(path, beams) > 0); });
  if (all.silent() && !found_paths->arrivals.silent()) all.lack = acoustics::PathLack::kTooWeak;
  return all;
}

// Both directions want the same.
void RayPropagation::begin_tick(SimTime at, const std::vector<EndPair>& all) {
  if (!budget_) return;
  std::vector<SearchBudget::Wanted> wanted;
  for (const auto& [from, to] : all) {
    const Task task = shared_task_of(at, from, to);
    const double range_m =
        std::max((to.position_ned_m - from.position_ned_m).norm(), acoustics::kMinDistance);
    const Decibels level = from.modem->source_level - Decibels{20 * elementary::log10(range_m)};
    wanted.push_back(
        {SearchBudget::id_of(task.ends), task.query, (level - to.modem->min_receivable_level).value});
  }
  budget_->begin_tick(at, wanted);
}

RayPropagation::Task RayPropagation::table_task_of(SimTime at, const LinkEnd& from, const LinkEnd& to) {
  Task task = shared_task_of(at, from, to);
  if (!budget_) return task;
  task.granted = budget_->find(SearchBudget::id_of(task.ends));
  task.waits = task.granted == nullptr;
  if (task.waits) return task;
  task.query = task.granted->query;
  task.age = at - task.granted->current_at;
  return task;
}

// What a budget has granted is kept for as long as it is used; the cache forgets.
RayPropagation::PathsPointer RayPropagation::known(const Task& task) {
  if (task.granted != nullptr && task.granted->paths) return task.granted->paths;
  const PathsPointer* paths = shared_found_.find(task.query.key());
  return paths == nullptr ? nullptr : *paths;
}

// The caches are read and written in turn; searches and results are shared out.
std::vector<Reception> RayPropagation::receptions(SimTime at, const std::vector<EndPair>& links,
                                                  const ForEach& for_each) {
  struct Search {
    std::size_t task, place;
    std::shared_ptr<const SeabedProfile> seabed;
  };
  std::vector<Task> tasks;
  std::map<PathQuery::Key, std::size_t> place_of;  // of each query, among `paths`
  std::vector<PathsPointer> paths;                 // null where the bottom is not known
  std::vector<Search> searches;
  for (const auto& [from, to] : links) {
    tasks.push_back(table_task_of(at, from, to));
    const Task& task = tasks.back();
    if (task.waits || !place_of.emplace(task.query.key(), paths.size()).second) continue;
    paths.push_back(known(task));
    if (paths.back()) continue;
    if (auto seabed = seabed_of(task.query))
      searches.push_back({tasks.size() - 1, paths.size() - 1, std::move(seabed)});
  }
  for_each(searches.size(), [&](std::size_t i) {
    paths[searches[i].place] = search(tasks[searches[i].task], *searches[i].seabed);
  });
  for (const Search& done : searches) shared_found_.insert(tasks[done.task].query.key(), paths[done.place]);
  searches_ += static_cast<std::int64_t>(searches.size());
  std::vector<Reception> receptions(links.size());
  const auto paths_of = [&](const Task& task) {
    return task.waits ? nullptr : paths[place_of.at(task.query.key())];
  };
  for_each(tasks.size(), [&](std::size_t i) {
    if (const PathsPointer found = paths_of(tasks[i])) receptions[i] = answer(tasks[i], *found);
  });
  for (std::size_t i = 0; i < links.size(); ++i) {
    const PathsPointer found = paths_of(tasks[i]);
    if (tasks[i].granted != nullptr) tasks[i].granted->paths = found;
    if (found) continue;
    receptions[i] = straight_instead(
        at, links[i],
        tasks[i].waits ? PropagationUsed::kStraightNotSearched : PropagationUsed::kStraightWithoutBottom);
  }
  return receptions;
}

bool RayPropagation::is_ready(SimTime at, const LinkEnd& from, const LinkEnd& to) {
  const bool ready = is_surveyed(task_of(at, from, to, from.id > to.id).query.places);
  return (!model_.reuse_for_packets || is_surveyed(packet_task_of(at, from, to).query.places)) && ready;
}

// Every link is looked at, so that all that is missing is requested together.
bool RayPropagation::are_ready(SimTime at, const std::vector<EndPair>& links) {
  bool ready = true;
  for (const auto& [from, to] : links) {
    ready = is_surveyed(shared_task_of(at, from, to).query.places) && ready;
  }
  return ready;
}

std::optional<acoustics::LeastLoss> RayPropagation::least_loss(SimTime at, double frequency_hz,
                                                               double deepest_end_m) const {
  const Decibels gain = gain_beyond_powers(model_, waters_->at(at));
  return acoustics::LeastLoss::of_rays(waters_->at(at), frequency_hz, deepest_end_m, gain);
}

std::shared_ptr<const SeabedProfile> RayPropagation::seabed_of(const PathQuery& q) const {
  if (q.given) return q.given;
  return seabed_->between({q.places[0], q.places[1], 0}, {q.places[2], q.places[3], 0});
}

std::shared_ptr<const acoustics::RayWater> RayPropagation::water_of(SimTime at, double frequency_hz) {
  return ray_waters_.find_or_make({waters_->water_at(at), frequency_hz}, [&] {
    return std::make_shared<const acoustics::RayWater>(
        ray_water(waters_->at(at), frequency_hz, model_.speed_tolerance_mps));
  });
}

RayPropagation::Task RayPropagation::task_of(SimTime at, const LinkEnd& from, const LinkEnd& to,
                                             bool reversed) {
  const acoustics::Environment& environment = waters_->at(at);
  const LinkEnd &first = reversed ? to : from, &last = reversed ? from : to;
  const Vec3 way = last.position_ned_m - first.position_ned_m;
  const double frequency_hz = from.modem->centre_frequency_hz;
  const acoustics::RayLink link = acoustics::held_apart(
      {depth_of(first, environment), depth_of(last, environment), elementary::hypot(way.x(), way.y())});
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

RayPropagation::Task RayPropagation::task_over(SimTime at, const LinkEnd& from, const LinkEnd& to,
                                               const std::shared_ptr<const SeabedProfile>& seabed) {
  Task task = task_of(at, from, to, /*reversed=*/false);
  task.query.places = {};
  task.query.given = seabed;
  return task;
}

RayPropagation::Task RayPropagation::shared_task_of(SimTime at, const LinkEnd& from, const LinkEnd& to) {
  Task task = task_of(at, from, to, from.id > to.id);
  // The phase of a path turns within centimetres.
  if (model_.reuse_distance_m <= 0 || model_.coherent) return task;
  if (auto shared = middle_of_cell(task.link, model_.reuse_distance_m)) {
    shared->source_depth_m = std::min(shared->source_depth_m, kDeepestEndM);
    shared->receiver_depth_m = std::min(shared->receiver_depth_m, kDeepestEndM);
    task.query.link = *shared;
    const double apart_m = model_.profile_reuse_distance_m;
    for (double& place_m : task.query.places) place_m = std::round(place_m / apart_m) * apart_m;
  }
  return task;
}

RayPropagation::Task RayPropagation::packet_task_of(SimTime at, const LinkEnd& from, const LinkEnd& to) {
  if (!model_.reuse_for_packets) return task_of(at, from, to, from.id > to.id);
  Task task = table_task_of(at, from, to);
  return task.waits ? shared_task_of(at, from, to) : task;
}

RayPropagation::PathsPointer RayPropagation::found(const Task& task, FoundCache& cache) {
  if (task.granted != nullptr && task.granted->paths) return task.granted->paths;
  const PathQuery::Key key = task.query.key();
  if (const PathsPointer* known = cache.find(key)) return *known;
  const auto seabed = seabed_of(task.query);
  if (!seabed) return nullptr;
  ++searches_;
  return cache.insert(key, search(task, *seabed));
}

Reception RayPropagation::straight_instead(SimTime at, const EndPair& ends, PropagationUsed used,
                                           acoustics::Capacity capacity) {
  Reception reception = straight_.along_line(at, ends, capacity);
  reception.used = used;
  return reception;
}

Reception RayPropagation::answer(const Task& task, const FoundPaths& found) const {
  Reception reception;
  reception.used = PropagationUsed::kRays;
  reception.paths_age = task.age;
  const acoustics::Arrivals arrivals = arrivals_at(task, found);
  reception.paths = with_reverberation(model_.reverberation, {found.mean_depth_m, boundaries_.trapped_share},
                                       sound_paths(task, arrivals));
  reception.delay_spread_s = delay_spread_s(reception.paths);
  reception.diffuse_level = diffuse_level(reception.paths);
  if (!reception.paths.empty()) {
    set_open(task, arrivals, reception);
  } else {
    reception.state = state_without_path(found);
    set_silent(task, reception);
  }
  return reception;
}

PathState RayPropagation::state_without_path(const FoundPaths& found) {
  using acoustics::PathLack;
  if (!found.arrivals.silent()) return PathState::kTooWeak;  // absorbed beyond what a double holds
  if (found.arrivals.lack == PathLack::kTooWeak) return PathState::kTooWeak;
  if (found.arrivals.lack == PathLack::kTooSteep) return PathState::kTooSteep;
  return found.blocked ? PathState::kBlocked : PathState::kShadow;
}

acoustics::Arrivals RayPropagation::arrivals_at(const Task& task, const FoundPaths& found) const {
  const acoustics::RayLink &searched = task.query.link, &link = task.link;
  const bool itself = searched.range_m == link.range_m && searched.source_depth_m == link.source_depth_m &&
                      searched.receiver_depth_m == link.receiver_depth_m;
  if (itself) return found.arrivals;
  const acoustics::EndSpeeds speeds{task.water->speed_at(searched.source_depth_m),
                                    task.water->speed_at(searched.receiver_depth_m)};
  return {found.arrivals.solver, extrapolate_arrivals(found.arrivals.paths, searched, speeds, link)};
}

std::vector<SoundPath> RayPropagation::sound_paths(const Task& task,
                                                   const acoustics::Arrivals& arrivals) const {
  std::vector<SoundPath> paths;
  for (const acoustics::Arrival& arrival : arrivals.paths) {
    if (const auto path = received_path(boundaries_, *task.environment, task.ends, arrival, task.reversed))
      paths.push_back(*path);
  }
  return paths;
}

LinkTracks RayPropagation::tracks(SimTime at, const LinkEnd& from, const LinkEnd& to) {
  const Task task = task_of(at, from, to, from.id > to.id);
  const PathsPointer found_paths = found(task, found_);
  if (!found_paths) return Propagation::tracks(at, from, to);
  const acoustics::BottomProfile bottom =
      bottom_under(*seabed_of(task.query), task.link, task.environment->sea_surface_z_m);
  const acoustics::RaySurface surface{model_.surface, task.environment->noise.wind_mps};
  std::vector<FoundPath> paths;
  for (const acoustics::Arrival& arrival : found_paths->arrivals.paths) {
    if (const auto path = received_path(boundaries_, *task.environment, task.ends, arrival, task.reversed)) {
      paths.push_back({arrival, *path,
                       kept_at_surface(boundaries_, *task.environment, task.query.frequency_hz, arrival)});
    }
  }
  LinkTracks tracks = tracks_of({*task.water, bottom, model_.bottom, surface, model_.options}, task.link,
                                task.reversed, std::move(paths), *from.modem, *to.modem);
  weigh(answer(task, *found_paths).paths, *to.modem, tracks);
  return tracks;
}

Decibels RayPropagation::received_level(const Task& task, const acoustics::Arrivals& arrivals,
                                        const std::vector<SoundPath>& paths) const {
  if (model_.fading.enabled) {
    const double power = mean_power(model_.fading, paths, task.ends.from.modem->band());
    return power > 0 ? std::max(to_decibels(PowerRatio{power}), kSilence) : kSilence;
  }
  if (!model_.coherent) return total_level(paths);
  const auto& [from, to] = task.ends;
  const LinkEnd &first = task.reversed ? to : from, &last = task.reversed ? from : to;
  acoustics::FieldOptions field;
  field.transducers = {first.modem->beam, last.modem->beam};
  return std::max(from.modem->source_level + coherent_level(arrivals, from.modem->centre_frequency_hz, field),
                  kSilence);
}

void RayPropagation::set_open(const Task& task, const acoustics::Arrivals& arrivals,
                              Reception& reception) const {
  const Vec3 &from = task.ends.from.position_ned_m, &to = task.ends.to.position_ned_m;
  const Decibels level = received_level(task, arrivals, reception.paths);
  const SoundPath& first = reception.paths[first_significant(reception.paths)];
  // As many arrivals as paths unless one was absorbed altogether: found again by its delay.
  const auto arrival = std::find_if(arrivals.paths.begin(), arrivals.paths.end(),
                                    [&](const auto& one) { return one.delay_s == first.delay_s; });
  acoustics::LinkBudget& budget = reception.budget;
  budget = task.kernel->budget_of_path(from, to, task.ends.from.modem->source_level - level,
                                       arrival->path_length_m, task.capacity);
  budget.delay_s = reception.paths[best_window(reception.paths, *task.ends.to.modem).strongest].delay_s;
  budget.mean_sound_speed_mps = std::max(budget.range_m, acoustics::kMinDistance) / first.delay_s;
  if (arrival->path_length_m > 0) {
    budget.absorption_db_per_km = 1000 * arrival->absorption_db / arrival->path_length_m;
  }
}

void RayPropagation::set_silent(const Task& task, Reception& reception) const {
  const Vec3 &from = task.ends.from.position_ned_m, &to = task.ends.to.position_ned_m;
  const bool leaks = (reception.state == PathState::kShadow || reception.state == PathState::kTooWeak) &&
                     model_.shadow_loss.has_value();
  const Decibels silent = task.ends.from.modem->source_level - kSilence;
  reception.budget = task.kernel->budget_of_path(from, to, leaks ? *model_.shadow_loss : silent,
                                                 (to - from).norm(), task.capacity);
  reception.budget.receivable = false;
}

}  // namespace halocline::channel_server
