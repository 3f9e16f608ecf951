// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/propagation/straight_propagation.h"

#include <algorithm>
#include <utility>

#include "acoustics/fading/arrival.h"
#include "acoustics/link/bottom_echo.h"
#include "acoustics/link/line_means.h"
#include "acoustics/link/link_budget.h"
#include "acoustics/link/ray_doppler.h"
#include "acoustics/modem/beam_pattern.h"
#include "acoustics/rays/eigenray.h"
#include "core/units.h"

namespace halocline::channel_server {
namespace {

Arrival straight_path(const acoustics::Environment& water, const acoustics::LinkBudget& budget,
                      const LinkEnd& from, const LinkEnd& to) {
  const double angle = acoustics::angle_down_rad(from.position_ned_m, to.position_ned_m);
  const Vec3 along = acoustics::ray_direction(from.position_ned_m, to.position_ned_m, angle);
  Arrival path;
  path.delay_s = budget.delay_s;
  path.level = budget.received_level;
  path.doppler_factor =
      acoustics::doppler_factor(from.velocity_ned_mps.dot(along), sound_speed_at(water, from.position_ned_m),
                                to.velocity_ned_mps.dot(along), sound_speed_at(water, to.position_ned_m));
  path.launch_angle_rad = path.arrival_angle_rad = angle;
  path.path_length_m = budget.range_m;
  path.absorption_db = budget.absorption_db_per_km * budget.range_m / 1000;
  return path;
}

// Sets the budget of a straight path through a field: delay and absorption are those along the line, and
// levels change by the difference in absorption from the profile.
void take_field(const acoustics::LinkKernel& kernel, const acoustics::Environment& water, const EndPair& ends,
                acoustics::Capacity capacity, acoustics::LinkBudget& budget) {
  const auto& [from, to] = ends;
  const acoustics::LineMeans means =
      acoustics::means_along(water, from.position_ned_m, to.position_ned_m, from.modem->band().centre_hz());
  const double absorbing_m = budget.range_m < acoustics::kMinDistance ? 0 : budget.range_m;
  const Decibels more{(means.absorption_db_per_km - budget.absorption_db_per_km) * absorbing_m / 1000};
  const Decibels loss = from.modem->source_level - budget.received_level + more;
  budget = kernel.budget_of_path(from.position_ned_m, to.position_ned_m, loss, absorbing_m, capacity,
                                 to.above_ambient);
  budget.delay_s = budget.range_m * means.slowness_s_per_m;
  budget.mean_sound_speed_mps = 1 / means.slowness_s_per_m;
  budget.absorption_db_per_km = means.absorption_db_per_km;
}

}  // namespace

StraightPropagation::StraightPropagation(acoustics::Environment environment, std::size_t max_kernels)
    : StraightPropagation(std::make_shared<const EnvironmentTimeline>(std::move(environment)),
                          acoustics::FadingModel(), nullptr, max_kernels) {}

StraightPropagation::StraightPropagation(std::shared_ptr<const EnvironmentTimeline> waters,
                                         const acoustics::FadingModel& fading,
                                         std::shared_ptr<SeabedMap> seabed, std::size_t max_kernels)
    : waters_(std::move(waters)), fading_(fading), seabed_(std::move(seabed)), kernels_(max_kernels) {}

// Every link is examined, so that all missing tiles are requested together.
bool StraightPropagation::are_ready(SimTime, const std::vector<EndPair>& links) {
  bool ready = true;
  for (const auto& [from, to] : links) {
    if (seabed_)
      ready =
          seabed_->are_places_surveyed(from.position_ned_m, to.position_ned_m, acoustics::kBottomDepths) &&
          ready;
  }
  return ready;
}

Multipath StraightPropagation::bottom_echo(const acoustics::LinkKernel& kernel, const EndPair& ends) const {
  const Vec3 &from = ends.from.position_ned_m, &to = ends.to.position_ned_m;
  std::array<double, acoustics::kBottomDepths> bottom_z_m{};
  if (!seabed_ || !seabed_->read_between(from, to, bottom_z_m)) return Multipath::kUnknown;
  return is_echo_likely(kernel, from, to, bottom_z_m) ? Multipath::kLikely : Multipath::kUnlikely;
}

Reception StraightPropagation::along_line(const acoustics::LinkKernel& kernel,
                                          const acoustics::Environment& water, const EndPair& ends,
                                          acoustics::Capacity capacity) const {
  const auto& [from, to] = ends;
  Reception reception;
  reception.budget = kernel.budget(from.position_ned_m, to.position_ned_m, capacity, to.above_ambient);
  if (water.field) take_field(kernel, water, ends, capacity, reception.budget);
  Arrival& path = reception.paths.emplace_back(straight_path(water, reception.budget, from, to));
  path.fading = path_fading(fading_, water.noise.wind_mps, from.modem->centre_frequency_hz, 0, 0);
  if (capacity == acoustics::Capacity::kComputed) reception.bottom_echo = bottom_echo(kernel, ends);
  return reception;
}

// Kernels are looked up sequentially because of their cache; links are distributed.
std::vector<Reception> StraightPropagation::receptions(SimTime at, const std::vector<EndPair>& links,
                                                       const ForEach& for_each) {
  std::vector<std::shared_ptr<const acoustics::LinkKernel>> kernels;
  for (const auto& [from, to] : links) kernels.push_back(kernel_of(at, *from.modem, *to.modem));
  const acoustics::Environment& water = waters_->at(at);
  std::vector<Reception> receptions(links.size());
  for_each(links.size(), [&](std::size_t i) {
    receptions[i] = along_line(*kernels[i], water, links[i], acoustics::Capacity::kComputed);
  });
  return receptions;
}

Reception StraightPropagation::blocked(SimTime at, const LinkEnd& from, const LinkEnd& to) {
  Reception reception;
  reception.state = PathState::kBlocked;
  const double distance_m = (to.position_ned_m - from.position_ned_m).norm();
  reception.budget =
      kernel_of(at, *from.modem, *to.modem)
          ->budget_of_path(from.position_ned_m, to.position_ned_m, from.modem->source_level - kSilence,
                           distance_m, acoustics::Capacity::kComputed, to.above_ambient);
  reception.budget.receivable = false;
  return reception;
}

StraightPropagation::ModemKey StraightPropagation::key_of(const acoustics::Modem& modem) {
  std::vector<double> beam;
  for (const acoustics::BeamRow& row : modem.beam.rows()) {
    beam.insert(beam.end(), {row.elevation_rad, row.loss_db});
  }
  const std::array<double, 5> numbers{modem.source_level.value, modem.min_receivable_level.value,
                                      modem.centre_frequency_hz, modem.bandwidth_hz,
                                      modem.directivity_index.value};
  return {numbers, std::move(beam), modem.family};
}

// True when key_of() is equal for both.
bool StraightPropagation::are_alike(const acoustics::Modem& a, const acoustics::Modem& b) {
  return a.source_level == b.source_level && a.min_receivable_level == b.min_receivable_level &&
         a.centre_frequency_hz == b.centre_frequency_hz && a.bandwidth_hz == b.bandwidth_hz &&
         a.directivity_index == b.directivity_index && a.family == b.family && a.beam == b.beam;
}

std::shared_ptr<const acoustics::LinkKernel> StraightPropagation::kernel_of(
    SimTime at, const acoustics::Modem& transmitter, const acoustics::Modem& receiver) {
  const EnvironmentTimeline::WaterId water = waters_->water_at(at);
  if (last_ && water == last_water_ && are_alike(last_->transmitter(), transmitter) &&
      are_alike(last_->receiver(), receiver))
    return last_;
  last_ = kernels_.find_or_make({water, key_of(transmitter), key_of(receiver)}, [&] {
    return std::make_shared<const acoustics::LinkKernel>(waters_->at(at), transmitter, receiver);
  });
  last_water_ = water;
  return last_;
}

}  // namespace halocline::channel_server
