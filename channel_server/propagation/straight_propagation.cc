// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/propagation/straight_propagation.h"

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "acoustics/fading/arrival.h"
#include "acoustics/link/bottom_echo.h"
#include "acoustics/link/line_means.h"
#include "acoustics/link/link_budget.h"
#include "acoustics/link/ray_doppler.h"
#include "acoustics/modem/beam_pattern.h"
#include "acoustics/rays/eigenray.h"
#include "channel_server/vehicles/vehicle_id.h"
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

// The links between two places of a table: one, or both directions.
struct LinksOfPair {
  std::size_t there;
  std::optional<std::size_t> back = {};
};

// Returns all links, each with the one in the opposite direction where there is one.
std::vector<LinksOfPair> links_of_pairs(const std::vector<EndPair>& links) {
  constexpr int kIdBits = 32;
  const auto key = [](VehicleId from, VehicleId to) {
    return std::uint64_t{static_cast<std::uint32_t>(from)} << kIdBits | static_cast<std::uint32_t>(to);
  };
  std::unordered_map<std::uint64_t, std::size_t> single;  // the order of iteration affects no result
  std::vector<LinksOfPair> pairs;
  for (std::size_t i = 0; i < links.size(); ++i) {
    const auto& [from, to] = links[i];
    const auto opposite = single.find(key(to.id, from.id));
    if (opposite != single.end()) {
      LinksOfPair& pair = pairs[opposite->second];
      const auto& [start, end] = links[pair.there];
      if (start.position_ned_m == to.position_ned_m && end.position_ned_m == from.position_ned_m) {
        pair.back = i;
        single.erase(opposite);
        continue;
      }
    }
    single.insert_or_assign(key(from.id, to.id), pairs.size());
    pairs.push_back({i});
  }
  return pairs;
}

// Returns the two ends, that farther south (west, up) first: the same for both directions of a pair.
std::pair<Vec3, Vec3> ends_of_pair(const EndPair& link) {
  const Vec3 &from = link.from.position_ned_m, &to = link.to.position_ned_m;
  const bool is_ordered = std::lexicographical_compare(from.begin(), from.end(), to.begin(), to.end());
  return is_ordered ? std::pair(from, to) : std::pair(to, from);
}

}  // namespace

StraightPropagation::StraightPropagation(acoustics::Environment environment, std::size_t max_kernels)
    : StraightPropagation(std::make_shared<const EnvironmentTimeline>(std::move(environment)),
                          acoustics::FadingModel(), nullptr, max_kernels) {}

StraightPropagation::StraightPropagation(std::shared_ptr<const EnvironmentTimeline> waters,
                                         const acoustics::FadingModel& fading,
                                         std::shared_ptr<SeabedMap> seabed, std::size_t max_kernels)
    : waters_(std::move(waters)), fading_(fading), seabed_(std::move(seabed)), kernels_(max_kernels) {}

// Every pair is examined, so that all missing tiles are requested together.
bool StraightPropagation::are_ready(SimTime, const std::vector<EndPair>& links) {
  if (!seabed_) return true;
  bool ready = true;
  for (const LinksOfPair& pair : links_of_pairs(links)) {
    const auto [first, last] = ends_of_pair(links[pair.there]);
    ready = seabed_->are_places_surveyed(first, last, acoustics::kBottomDepths) && ready;
  }
  return ready;
}

// The depths are read from the same end for both directions, so a pair of links shares them to the last bit.
void StraightPropagation::add_bottom_echoes(std::span<const EchoQuery> links_of_one_pair) const {
  std::array<double, acoustics::kBottomDepths> bottom_z_m{};
  const auto [first, last] = ends_of_pair(links_of_one_pair.front().ends);
  if (!seabed_ || !seabed_->read_between(first, last, bottom_z_m)) return;
  bool is_reversed = false;
  for (const auto& [kernel, ends, reception] : links_of_one_pair) {
    const Vec3 &from = ends.from.position_ned_m, &to = ends.to.position_ned_m;
    if (is_reversed != (from != first)) {
      std::ranges::reverse(bottom_z_m);
      is_reversed = !is_reversed;
    }
    reception.bottom_echo =
        is_echo_likely(kernel, from, to, bottom_z_m) ? Multipath::kLikely : Multipath::kUnlikely;
  }
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
  return reception;
}

Reception StraightPropagation::along_line(SimTime at, const EndPair& ends, acoustics::Capacity capacity) {
  const auto kernel = kernel_of(at, *ends.from.modem, *ends.to.modem);
  Reception reception = along_line(*kernel, waters_->at(at), ends, capacity);
  const std::array query = {EchoQuery{*kernel, ends, reception}};
  if (capacity == acoustics::Capacity::kComputed) add_bottom_echoes(query);
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
  if (!seabed_) return receptions;
  const std::vector<LinksOfPair> pairs = links_of_pairs(links);
  for_each(pairs.size(), [&](std::size_t i) {
    const auto query = [&](std::size_t link) {
      return EchoQuery{*kernels[link], links[link], receptions[link]};
    };
    const std::array queries = {query(pairs[i].there), query(pairs[i].back.value_or(pairs[i].there))};
    add_bottom_echoes({queries.data(), pairs[i].back ? 2u : 1u});
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
  if (at >= next_forgetting_) {
    kernels_.forget_unused();
    next_forgetting_ = at + kKept;
  }
  last_ = kernels_.find_or_make({water, key_of(transmitter), key_of(receiver)}, [&] {
    return std::make_shared<const acoustics::LinkKernel>(waters_->at(at), transmitter, receiver);
  });
  last_water_ = water;
  return last_;
}

}  // namespace halocline::channel_server
