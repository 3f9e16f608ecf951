#include "channel_server/propagation/ray_propagation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "acoustics/fading/link_fading.h"
#include "acoustics/fading/scattering_loss.h"
#include "acoustics/link/link_budget.h"
#include "acoustics/link/received_field.h"
#include "acoustics/rays/arc_tracer.h"
#include "acoustics/rays/extrapolate_arrivals.h"
#include "acoustics/reception/guard_window.h"
#include "acoustics/sea/bottom_profile.h"
#include "channel_server/propagation/link_tracks.h"
#include "channel_server/propagation/ray_cells.h"
#include "channel_server/propagation/ray_limits.h"
#include "channel_server/propagation/ray_tracks.h"
#include "channel_server/propagation/received_path.h"
#include "core/check.h"
#include "core/elementary.h"

namespace halocline::channel_server {
namespace {

constexpr std::size_t kMaxFound = 4096, kMaxSharedFound = 32'768;  // searches, 7 kB each
constexpr std::size_t kMaxRayWaters = 256;                         // 20 kB each
// The deepest that an end may be, m: there has to be bottom below it.
constexpr double kDeepestEndM = acoustics::kDeepestWater - 1;

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
  validate(model.bottom);
  validate(model.options);
  validate(model.fading);
  validate(model.reverberation);
  require_in_range(model.speed_tolerance_mps, 0, 1, "tolerance of sound speed for rays", "m/s");
  require_in_range(model.reuse_distance_m, 0, 1000, "distance of reuse of paths", "m");
  require_in_range(model.profile_reuse_distance_m, 0.1, 1000, "distance of reuse of bottom profiles", "m");
}

Reception RayPropagation::reception(SimTime at, const LinkEnd& from, const LinkEnd& to) {
  const Task task = task_of(at, from, to, from.id > to.id);
  const FoundPaths paths = found(task);
  return paths ? answer(task, *paths) : without_bottom(at, from, to);
}

Reception RayPropagation::reception_over(SimTime at, const LinkEnd& from, const LinkEnd& to,
                                         const std::shared_ptr<const SeabedProfile>& seabed) {
  if (!seabed) return without_bottom(at, from, to);
  const Task task = task_over(at, from, to, seabed);
  return answer(task, *found(task));
}

acoustics::Arrivals RayPropagation::arrivals_over(SimTime at, const LinkEnd& from, const LinkEnd& to,
                                                  const std::shared_ptr<const SeabedProfile>& seabed) {
  const FoundPaths found_paths = found(task_over(at, from, to, seabed));
  acoustics::Arrivals all = found_paths->arrivals;
  const acoustics::Transducers beams{from.modem->beam, to.modem->beam};
  std::erase_if(all.paths,
                [&](const acoustics::Arrival& path) { return !(weighted_pressure(path, beams) > 0); });
  if (all.silent() && !found_paths->arrivals.silent()) all.lack = acoustics::PathLack::kTooWeak;
  return all;
}

// The caches are read and written in turn; searches and results are shared out.
std::vector<Reception> RayPropagation::receptions(SimTime at, const std::vector<EndPair>& links,
                                                  const ForEach& for_each) {
  struct Search {
    std::size_t task, place;
    std::shared_ptr<const SeabedProfile> seabed;
  };
  std::vector<Task> tasks;
  std::map<Key, std::size_t> place_of;  // of each query, among `paths`
  std::vector<FoundPaths> paths;        // null where the bottom is not known
  std::vector<Search> searches;
  for (const auto& [from, to] : links) {
    tasks.push_back(shared_task_of(at, from, to));
    const PathQuery& query = tasks.back().query;
    if (!place_of.emplace(key_of(query), paths.size()).second) continue;
    const FoundPaths* known = shared_found_.find(key_of(query));
    paths.push_back(known == nullptr ? nullptr : *known);
    if (known != nullptr) continue;
    if (auto seabed = seabed_of(query))
      searches.push_back({tasks.size() - 1, paths.size() - 1, std::move(seabed)});
  }
  for_each(searches.size(), [&](std::size_t i) {
    paths[searches[i].place] = search(tasks[searches[i].task], *searches[i].seabed);
  });
  for (const Search& done : searches) shared_found_.insert(key_of(tasks[done.task].query), paths[done.place]);
  searches_ += static_cast<std::int64_t>(searches.size());
  std::vector<Reception> receptions(links.size());
  const auto paths_of = [&](std::size_t i) -> const FoundPaths& {
    return paths[place_of.at(key_of(tasks[i].query))];
  };
  for_each(tasks.size(), [&](std::size_t i) {
    if (paths_of(i)) receptions[i] = answer(tasks[i], *paths_of(i));
  });
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (!paths_of(i)) receptions[i] = without_bottom(at, links[i].from, links[i].to);
  }
  return receptions;
}

bool RayPropagation::is_ready(SimTime at, const LinkEnd& from, const LinkEnd& to) {
  return is_surveyed(task_of(at, from, to, from.id > to.id).query.places);
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

RayPropagation::Key RayPropagation::key_of(const PathQuery& q) {
  return {q.water_id,
          q.frequency_hz,
          q.places,
          q.seabed_version,
          q.given.get(),
          q.link.source_depth_m,
          q.link.receiver_depth_m,
          q.link.range_m};
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
  const Places places{first.position_ned_m.x(), first.position_ned_m.y(), last.position_ned_m.x(),
                      last.position_ned_m.y()};
  return {{from, to},
          &environment,
          water_of(at, frequency_hz),
          straight_.model_of(at, *from.modem, *to.modem),
          {waters_->water_at(at), frequency_hz, places, seabed_->version(), nullptr, link},
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

RayPropagation::FoundPaths RayPropagation::search(const Task& task, const SeabedProfile& seabed) const {
  const PathQuery& q = task.query;
  acoustics::RayOptions options = model_.options;
  options.frequency_hz = q.frequency_hz;
  const acoustics::BottomProfile bottom = bottom_under(seabed, q.link, task.environment->sea_surface_z_m);
  const double depth_m = mean_depth_m(bottom, q.link.range_m);
  if (model_.bounces_follow_range) options.max_bounces = bounces_for(q.link.range_m, depth_m);
  const acoustics::RaySea sea{*task.water, bottom, model_.bottom,
                              acoustics::RaySurface{model_.surface, task.environment->noise.wind_mps},
                              options};
  auto found = std::make_shared<Found>();
  found->given = q.given;
  found->mean_depth_m = depth_m;
  found->arrivals = arrivals(sea, q.link, usable_solver(model_.solver, sea, q.link));
  found->blocked = cuts_straight_line(sea.bottom_profile, q.link);
  return found;
}

RayPropagation::FoundPaths RayPropagation::found(const Task& task) {
  const Key key = key_of(task.query);
  if (const FoundPaths* known = found_.find(key)) return *known;
  const auto seabed = seabed_of(task.query);
  if (!seabed) return nullptr;
  ++searches_;
  return found_.insert(key, search(task, *seabed));
}

Reception RayPropagation::without_bottom(SimTime at, const LinkEnd& from, const LinkEnd& to) {
  Reception reception = straight_.reception(at, from, to);
  reception.used = PropagationUsed::kStraightWithoutBottom;
  return reception;
}

Reception RayPropagation::answer(const Task& task, const Found& found) const {
  Reception reception;
  reception.used = PropagationUsed::kRays;
  const acoustics::Arrivals arrivals = arrivals_at(task, found);
  reception.paths = with_reverberation(model_.reverberation, {found.mean_depth_m, boundaries_.trapped_share},
                                       sound_paths(task, arrivals));
  reception.delay_spread_s = delay_spread_s(reception.paths);
  if (!reception.paths.empty()) {
    set_open(task, arrivals, reception);
  } else {
    reception.state = state_without_path(found);
    set_silent(task, reception);
  }
  return reception;
}

PathState RayPropagation::state_without_path(const Found& found) {
  using acoustics::PathLack;
  if (!found.arrivals.silent()) return PathState::kTooWeak;  // absorbed beyond what a double holds
  if (found.arrivals.lack == PathLack::kTooWeak) return PathState::kTooWeak;
  if (found.arrivals.lack == PathLack::kTooSteep) return PathState::kTooSteep;
  return found.blocked ? PathState::kBlocked : PathState::kShadow;
}

acoustics::Arrivals RayPropagation::arrivals_at(const Task& task, const Found& found) const {
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
  const FoundPaths found_paths = found(task);
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
  budget = task.budget->budget_of_path(from, to, task.ends.from.modem->source_level - level,
                                       arrival->path_length_m);
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
  reception.budget =
      task.budget->budget_of_path(from, to, leaks ? *model_.shadow_loss : silent, (to - from).norm());
  reception.budget.receivable = false;
}

}  // namespace halocline::channel_server
