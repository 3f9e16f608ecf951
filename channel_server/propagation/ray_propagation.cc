// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/propagation/ray_propagation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "acoustics/fading/link_fading.h"
#include "acoustics/fading/near_surface.h"
#include "acoustics/fading/reverberation.h"
#include "acoustics/link/energy_flux.h"
#include "acoustics/link/field_section.h"
#include "acoustics/link/link_budget.h"
#include "acoustics/link/link_kernel.h"
#include "acoustics/link/received_field.h"
#include "acoustics/rays/arc_tracer.h"
#include "acoustics/reception/guard_window.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/ray_water.h"
#include "channel_server/propagation/link_chart.h"
#include "channel_server/propagation/path_reuse.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/ray_arrival.h"
#include "channel_server/propagation/ray_chart.h"
#include "core/elementary.h"

namespace halocline::channel_server {
RayPropagation::RayPropagation(std::shared_ptr<const EnvironmentTimeline> waters,
                               std::shared_ptr<SeabedMap> seabed, const RayModel& model)
    : waters_(std::move(waters)),
      seabed_(std::move(seabed)),
      model_(with_turned_seas(model)),
      boundaries_{model.fading, acoustics::trapped_share(model.bottom)},
      straight_(waters_, model.fading),
      searches_(waters_, seabed_, model_, straight_) {}

Reception RayPropagation::along_rays(SimTime at, const Task& task, acoustics::Capacity capacity) {
  const LinkSearches::Paths paths = searches_.find(task);
  return paths ? answer(task, *paths, capacity)
               : straight_instead(at, task.ends, PropagationUsed::kStraightWithoutBottom, capacity);
}

Reception RayPropagation::reception_over(SimTime at, const LinkEnd& from, const LinkEnd& to,
                                         const std::shared_ptr<const SeabedProfile>& seabed) {
  if (!seabed) return straight_instead(at, {from, to}, PropagationUsed::kStraightWithoutBottom);
  const Task task = searches_.over(at, from, to, seabed);
  return answer(task, *searches_.find(task), acoustics::Capacity::kComputed);
}

Reception RayPropagation::reception_over(SimTime at, const LinkEnd& from, const LinkEnd& to,
                                         const std::shared_ptr<const SeabedProfile>& seabed,
                                         SharedLine* line) {
  constexpr auto kCapacity = acoustics::Capacity::kLeftOut;
  if (!seabed) return straight_instead(at, {from, to}, PropagationUsed::kStraightWithoutBottom, kCapacity);
  const Task task = searches_.over(at, from, to, seabed);
  return answer(task, *searches_.find(task, line), kCapacity);
}

std::vector<std::optional<Reception>> RayPropagation::packet_receptions(SimTime at,
                                                                        const std::vector<EndPair>& links,
                                                                        const ForEach& for_each) {
  std::vector<Task> tasks;
  std::vector<std::size_t> places;  // index of each task's link in `links`
  for (std::size_t i = 0; i < links.size(); ++i) {
    Task task = searches_.for_packet(at, links[i].from, links[i].to);
    if (!searches_.is_ready(task)) continue;
    tasks.push_back(std::move(task));
    places.push_back(i);
  }
  const std::vector<LinkSearches::Paths> paths = searches_.find_all(tasks, for_each);
  std::vector<std::optional<Reception>> receptions(links.size());
  for_each(tasks.size(), [&](std::size_t i) {
    if (paths[i]) receptions[places[i]] = answer(tasks[i], *paths[i], acoustics::Capacity::kLeftOut);
  });
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (paths[i]) continue;
    receptions[places[i]] = straight_instead(at, tasks[i].ends, PropagationUsed::kStraightWithoutBottom,
                                             acoustics::Capacity::kLeftOut);
  }
  return receptions;
}

std::vector<LinkSearches::Task> RayPropagation::table_tasks(SimTime at, const std::vector<EndPair>& links) {
  std::vector<Task> tasks;
  for (const auto& [from, to] : links) tasks.push_back(searches_.for_table(at, from, to));
  return tasks;
}

std::vector<Reception> RayPropagation::receptions(SimTime at, const std::vector<EndPair>& links,
                                                  const ForEach& for_each) {
  const std::vector<Task> tasks = table_tasks(at, links);
  const std::vector<LinkSearches::Paths> paths = searches_.find_all(tasks, for_each);
  std::vector<Reception> receptions(links.size());
  for_each(tasks.size(), [&](std::size_t i) {
    if (paths[i]) receptions[i] = answer(tasks[i], *paths[i], acoustics::Capacity::kComputed);
  });
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (paths[i]) continue;
    receptions[i] = straight_instead(
        at, links[i],
        tasks[i].waits ? PropagationUsed::kStraightNotSearched : PropagationUsed::kStraightWithoutBottom);
  }
  return receptions;
}

bool RayPropagation::are_ready(SimTime at, const std::vector<EndPair>& links) {
  return searches_.are_ready_for_table(at, links);
}

std::optional<acoustics::LeastLoss> RayPropagation::least_loss(SimTime at, double frequency_hz,
                                                               double deepest_end_m) const {
  const Decibels gain = gain_beyond_powers(model_, waters_->at(at));
  return acoustics::LeastLoss::of_rays(waters_->at(at), frequency_hz, deepest_end_m, gain,
                                       {model_.least_depth_m, model_.greatest_depth_m, model_.bottom});
}

std::optional<FluxOnlyLinks> RayPropagation::flux_only_links(SimTime at, double frequency_hz,
                                                             double deepest_end_m) const {
  const acoustics::Environment& environment = waters_->at(at);
  if (!(model_.options.diffuse_below_db > 0) || !(model_.least_depth_m > 0) || environment.field)
    return std::nullopt;
  const acoustics::RayWater water = ray_water(environment, frequency_hz, model_.speed_tolerance_mps);
  acoustics::RayOptions options = model_.options;
  options.frequency_hz = frequency_hz;
  const acoustics::EnergyFluxSea sea{water, model_.least_depth_m, model_.bottom,
                                     surface_of(model_, environment), options};
  const Decibels gain = acoustics::kFocusingGain + gain_beyond_powers(model_, environment);
  return FluxOnlyLinks{{sea, {model_.least_depth_m, model_.greatest_depth_m, deepest_end_m}, gain},
                       model_.diffuse_below_noise + model_.weak_below_diffuse};
}

Reception RayPropagation::straight_instead(SimTime at, const EndPair& ends, PropagationUsed used,
                                           acoustics::Capacity capacity) {
  Reception reception = straight_.along_line(at, ends, capacity);
  reception.used = used;
  if (used != PropagationUsed::kStraightWithoutBottom || model_.holds_terrain) return reception;
  reception.state = PathState::kNoTerrain;
  reception.paths.clear();
  const Vec3 &from = ends.from.position_ned_m, &to = ends.to.position_ned_m;
  reception.budget = straight_.kernel_of(at, *ends.from.modem, *ends.to.modem)
                         ->budget_of_path(from, to, ends.from.modem->source_level - kSilence,
                                          (to - from).norm(), capacity, ends.to.above_ambient);
  reception.budget.receivable = false;
  return reception;
}

Reception RayPropagation::answer(const Task& task, const SearchResult& found,
                                 acoustics::Capacity capacity) const {
  Reception reception;
  reception.used = found.beyond_terrain ? PropagationUsed::kRaysBeyondTerrain : PropagationUsed::kRays;
  reception.paths_age = task.age;
  if (lacks_terrain(found)) {
    reception.state = PathState::kNoTerrain;
    set_silent(task, capacity, reception);
    return reception;
  }
  const std::optional<acoustics::Eigenrays> elsewhere =
      reused_eigenrays(task.link, task.query, *task.water, *task.environment, found.eigenrays);
  const acoustics::Eigenrays& eigenrays = elsewhere ? *elsewhere : found.eigenrays;
  reception.solver = eigenrays.solver;
  reception.paths = with_reverberation(model_.reverberation, {found.mean_depth_m, boundaries_.trapped_share},
                                       arrivals(task, eigenrays, found.mean_depth_m));
  reception.delay_spread_s = delay_spread_s(reception.paths);
  reception.diffuse_level = diffuse_level(reception.paths);
  if (model_.near_surface && model_.fading.enabled) {
    const auto& [from, to] = task.ends;
    for (const LinkEnd* end : {&from, &to}) {
      reception.share_under_water *=
          model_.near_surface->share_under_water(end->id, end->position_ned_m.z(), *task.environment);
    }
  }
  if (!reception.paths.empty()) {
    set_open(task, eigenrays, capacity, reception);
  } else {
    reception.state = state_without_path(found);
    set_silent(task, capacity, reception);
  }
  return reception;
}

PathState RayPropagation::state_without_path(const SearchResult& found) {
  using acoustics::PathLack;
  if (!found.eigenrays.silent()) return PathState::kTooWeak;  // absorbed beyond the range of a double
  if (found.eigenrays.lack == PathLack::kTooWeak) return PathState::kTooWeak;
  if (found.eigenrays.lack == PathLack::kTooSteep) return PathState::kTooSteep;
  return found.blocked ? PathState::kBlocked : PathState::kShadow;
}

std::vector<Arrival> RayPropagation::arrivals(const Task& task, const acoustics::Eigenrays& eigenrays,
                                              double depth_m) const {
  const RoughBoundaries& boundaries = boundaries_;
  std::optional<SurfacePassage> passage;
  if (model_.near_surface && model_.fading.enabled)
    passage.emplace(*model_.near_surface, *task.environment, task.ends, task.query.frequency_hz);
  const Decibels keels = keel_loss(*task.environment, depth_m, task.link.range_m);
  std::vector<Arrival> paths;
  for (const acoustics::Eigenray& eigenray : eigenrays.paths) {
    acoustics::Eigenray path = eigenray;
    const acoustics::SurfaceCrossing crossing =
        passage ? passage->cross(*task.water, task.link, path) : acoustics::SurfaceCrossing();
    auto arrival = arrival_of(boundaries, *task.environment, task.ends, path, task.reversed);
    if (!arrival) continue;
    if (passage) passage->set_waves(crossing, *arrival);
    if (keels.value > 0) arrival->level = std::max(arrival->level - keels, kSilence);
    paths.push_back(*arrival);
  }
  return paths;
}

LinkChart RayPropagation::chart(SimTime at, const LinkEnd& from, const LinkEnd& to) {
  const Task task = searches_.for_itself(at, from, to);
  const LinkSearches::Paths found = searches_.find(task);
  if (!found) return Propagation::chart(at, from, to);
  const acoustics::BottomProfile bottom =
      bottom_under(*searches_.seabed_of(task.query), task.link, task.environment->sea_surface_z_m);
  const acoustics::RaySurface surface = surface_of(model_, *task.environment);
  std::vector<LinkChart::Row> rows;
  std::vector<Arrival> of_paths;
  if (!lacks_terrain(*found)) of_paths = arrivals(task, found->eigenrays, found->mean_depth_m);
  for (const Arrival& arrival : of_paths) {
    const Decibels kept = kept_at_surface(boundaries_, *task.environment, task.query.frequency_hz, arrival);
    rows.push_back({.arrival = arrival, .surface_db = arrival.surface_loss_db - kept.value});
  }
  const acoustics::LinkWater water =
      water_along(model_, *task.water, *task.environment, task.query, bottom.deepest_m());
  LinkChart chart = chart_of({water.water, bottom, model_.bottom, surface, model_.options,
                              /*core_speed_mps=*/0, water.section.get()},
                             task.link, task.reversed, std::move(rows), *from.modem, *to.modem);
  chart.weigh(answer(task, *found, acoustics::Capacity::kLeftOut).paths, *to.modem);
  return chart;
}

Decibels RayPropagation::received_level(const Task& task, const acoustics::Eigenrays& eigenrays,
                                        const std::vector<Arrival>& paths) const {
  if (model_.fading.enabled) {
    const double power = mean_power(model_.fading, paths, task.ends.from.modem->band());
    return power > 0 ? std::max(to_decibels(PowerRatio{power}), kSilence) : kSilence;
  }
  if (!model_.coherent) return total_level(paths);
  const auto& [from, to] = task.ends;
  const LinkEnd &first = task.reversed ? to : from, &last = task.reversed ? from : to;
  acoustics::FieldOptions field;
  field.transducers = {first.modem->beam, last.modem->beam};
  return std::max(
      from.modem->source_level + coherent_level(eigenrays, from.modem->centre_frequency_hz, field), kSilence);
}

void RayPropagation::set_open(const Task& task, const acoustics::Eigenrays& eigenrays,
                              acoustics::Capacity capacity, Reception& reception) const {
  const Vec3 &from = task.ends.from.position_ned_m, &to = task.ends.to.position_ned_m;
  const Decibels level = received_level(task, eigenrays, reception.paths);
  const Arrival& first = reception.paths[first_significant(reception.paths)];
  acoustics::LinkBudget& budget = reception.budget;
  budget = task.kernel->budget_of_path(from, to, task.ends.from.modem->source_level - level,
                                       first.path_length_m, capacity, task.ends.to.above_ambient);
  budget.delay_s = reception.paths[best_window(reception.paths, *task.ends.to.modem).strongest].delay_s;
  if (first.delay_s > 0) budget.mean_sound_speed_mps = budget.range_m / first.delay_s;
  if (first.path_length_m > 0) budget.absorption_db_per_km = 1000 * first.absorption_db / first.path_length_m;
}

void RayPropagation::set_silent(const Task& task, acoustics::Capacity capacity, Reception& reception) const {
  const Vec3 &from = task.ends.from.position_ned_m, &to = task.ends.to.position_ned_m;
  const bool leaks = (reception.state == PathState::kShadow || reception.state == PathState::kTooWeak) &&
                     model_.shadow_loss.has_value();
  const Decibels silent = task.ends.from.modem->source_level - kSilence;
  reception.budget = task.kernel->budget_of_path(from, to, leaks ? *model_.shadow_loss : silent,
                                                 (to - from).norm(), capacity, task.ends.to.above_ambient);
  reception.budget.receivable = false;
}

}  // namespace halocline::channel_server
