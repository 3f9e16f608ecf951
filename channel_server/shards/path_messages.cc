// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/shards/path_messages.h"

#include <algorithm>
#include <limits>

#include "acoustics/rays/eigenray.h"
#include "bus/messages/message_checks.h"

namespace halocline::channel_server {
namespace {

constexpr std::size_t kMaxEigenrays = 400;

bool fits(const acoustics::Eigenray& path) {
  const acoustics::PathIdentity& id = path.identity;
  return std::max({path.surface_bounces, path.bottom_bounces, path.caustics, id.surface_bounces,
                   id.bottom_bounces, id.upper_turns, id.lower_turns, id.branch}) <=
         std::numeric_limits<std::int16_t>::max();
}

eigenray_t to_message(const acoustics::Eigenray& path) {
  const auto count = [](int number) { return static_cast<std::int16_t>(number); };
  const acoustics::PathIdentity& id = path.identity;
  return {.delay_s = path.delay_s,
          .amplitude = path.amplitude,
          .phase_rad = path.phase_rad,
          .launch_angle_rad = path.launch_angle_rad,
          .arrival_angle_rad = path.arrival_angle_rad,
          .launch_slowness_spm = path.launch_slowness_spm,
          .range_slowness_spm = path.range_slowness_spm,
          .path_length_m = path.path_length_m,
          .absorption_db = path.absorption_db,
          .surface_loss_db = path.surface_loss_db,
          .bottom_loss_db = path.bottom_loss_db,
          .surface_sine_squares = path.surface_sine_squares,
          .bottom_sine_squares = path.bottom_sine_squares,
          .surface_bounces = count(path.surface_bounces),
          .bottom_bounces = count(path.bottom_bounces),
          .caustics = count(path.caustics),
          .is_diffuse = path.diffuse,
          .launched_up = id.launched_up,
          .known_surface_bounces = count(id.surface_bounces),
          .known_bottom_bounces = count(id.bottom_bounces),
          .upper_turns = count(id.upper_turns),
          .lower_turns = count(id.lower_turns),
          .branch = count(id.branch)};
}

acoustics::Eigenray to_eigenray(const eigenray_t& m) {
  acoustics::Eigenray path;
  path.delay_s = m.delay_s;
  path.amplitude = m.amplitude;
  path.phase_rad = m.phase_rad;
  path.launch_angle_rad = m.launch_angle_rad;
  path.arrival_angle_rad = m.arrival_angle_rad;
  path.launch_slowness_spm = m.launch_slowness_spm;
  path.range_slowness_spm = m.range_slowness_spm;
  path.path_length_m = m.path_length_m;
  path.absorption_db = m.absorption_db;
  path.surface_loss_db = m.surface_loss_db;
  path.bottom_loss_db = m.bottom_loss_db;
  path.surface_sine_squares = m.surface_sine_squares;
  path.bottom_sine_squares = m.bottom_sine_squares;
  path.surface_bounces = m.surface_bounces;
  path.bottom_bounces = m.bottom_bounces;
  path.caustics = m.caustics;
  path.diffuse = m.is_diffuse != 0;
  path.identity = {m.launched_up != 0, m.known_surface_bounces, m.known_bottom_bounces,
                   m.upper_turns,      m.lower_turns,           m.branch};
  return path;
}

}  // namespace

std::optional<link_search_t> to_message(std::int64_t sea_hash, const PathQuery& query,
                                        const SearchResult& found) {
  const auto& paths = found.eigenrays.paths;
  if (paths.size() > kMaxEigenrays || !std::all_of(paths.begin(), paths.end(), fits)) return std::nullopt;
  link_search_t message;
  message.sea_hash = sea_hash;
  message.frequency_hz = query.frequency_hz;
  std::copy(query.places.begin(), query.places.end(), message.profile_ends_m);
  message.source_depth_m = query.link.source_depth_m;
  message.receiver_depth_m = query.link.receiver_depth_m;
  message.range_m = query.link.range_m;
  message.diffuse_below_pressure = query.diffuse_below_pressure;
  message.mean_depth_m = found.mean_depth_m;
  message.is_blocked = found.blocked;
  message.is_beyond_terrain = found.beyond_terrain;
  message.ray_solver = static_cast<std::int8_t>(found.eigenrays.solver);
  message.path_lack = static_cast<std::int8_t>(found.eigenrays.lack);
  for (const acoustics::Eigenray& path : paths) message.eigenrays.push_back(to_message(path));
  message.num_eigenrays = static_cast<std::int32_t>(paths.size());
  return bus::problem_in(message).empty() ? std::optional(std::move(message)) : std::nullopt;
}

PathQuery to_query(const link_search_t& message) {
  PathQuery query;
  query.frequency_hz = message.frequency_hz;
  std::copy(std::begin(message.profile_ends_m), std::end(message.profile_ends_m), query.places.begin());
  query.link = {message.source_depth_m, message.receiver_depth_m, message.range_m};
  query.diffuse_below_pressure = message.diffuse_below_pressure;
  return query;
}

SearchResult to_result(const link_search_t& message) {
  SearchResult found;
  found.mean_depth_m = message.mean_depth_m;
  found.blocked = message.is_blocked != 0;
  found.beyond_terrain = message.is_beyond_terrain != 0;
  found.eigenrays.solver = static_cast<acoustics::RaySolver>(message.ray_solver);
  found.eigenrays.lack = static_cast<acoustics::PathLack>(message.path_lack);
  found.eigenrays.paths.reserve(message.eigenrays.size());
  for (const eigenray_t& path : message.eigenrays) found.eigenrays.paths.push_back(to_eigenray(path));
  return found;
}

}  // namespace halocline::channel_server
