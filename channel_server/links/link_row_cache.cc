// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/links/link_row_cache.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "acoustics/fading/arrival.h"
#include "acoustics/link/ray_doppler.h"
#include "acoustics/rays/eigenray.h"
#include "core/check.h"
#include "core/elementary.h"

namespace halocline::channel_server {
namespace {

constexpr double kDepthsCount = 10, kRangeShare = 1.0 / 40;  // equal to those of the cells of path_search.h

double horizontal_m(const Vec3& from, const Vec3& to) {
  return elementary::hypot(to.x() - from.x(), to.y() - from.y());
}

// Returns the distance moved, m, in which depth counts kDepthsCount times.
double moved_m(const Vec3& then, const Vec3& now) {
  return horizontal_m(then, now) + kDepthsCount * std::abs(now.z() - then.z());
}

}  // namespace

LinkRowCache::LinkRowCache(double reuse_distance_m) : reuse_distance_m_(reuse_distance_m) {
  require_in_range(reuse_distance_m, 0, 1000, "distance over which rows are reused", "m");
}

void LinkRowCache::clear() {
  modems_.clear();
  rows_.clear();
}

void LinkRowCache::know_modems(const std::vector<PlacedVehicle>& vehicles) {
  std::map<VehicleId, KnownModem> known;
  for (const PlacedVehicle& vehicle : vehicles) {
    const acoustics::Modem& modem = vehicle.modem->modem;
    const auto before = modems_.find(vehicle.id);
    const bool same = before != modems_.end() && before->second.modem == modem;
    known.emplace(vehicle.id, same ? std::move(before->second) : KnownModem{modem, tick_});
  }
  modems_ = std::move(known);
}

bool LinkRowCache::holds(const Kept& kept, const EndPair& now) const {
  const auto& [from, to] = now;
  const double range_m = (to.position_ned_m - from.position_ned_m).norm();
  const auto is_steady = [](const Vec3& then_mps, const Vec3& now_mps) {
    return (now_mps - then_mps).squaredNorm() <= kMaxVelocityChange * kMaxVelocityChange;
  };
  return tick_ - kept.made_at <= kLongest &&
         moved_m(kept.from_ned_m, from.position_ned_m) + moved_m(kept.to_ned_m, to.position_ned_m) <=
             std::min(reuse_distance_m_, kRangeShare * range_m) &&
         is_steady(kept.from_mps, from.velocity_ned_mps) && is_steady(kept.to_mps, to.velocity_ned_mps) &&
         modems_.at(from.id).since <= kept.made_at && modems_.at(to.id).since <= kept.made_at;
}

LinkRow LinkRowCache::reused(const Kept& kept, const EndPair& now, SimTime tick,
                             const acoustics::Environment& environment) {
  const Vec3 &from = now.from.position_ned_m, &to = now.to.position_ned_m;
  const double from_mps = sound_speed_at(environment, from), to_mps = sound_speed_at(environment, to);
  const double apart_m = horizontal_m(from, to) - horizontal_m(kept.from_ned_m, kept.to_ned_m);
  // Change of the delay by Fermat's principle:
  //   (cos a dr - sin a dz_transmitter) / c_transmitter + sin b dz_receiver / c_receiver
  const auto later_s = [&](const Angles& path) {
    const auto launch = elementary::sin_cos(path.launch_rad);
    return (launch.cosine * apart_m - launch.sine * (from.z() - kept.from_ned_m.z())) / from_mps +
           elementary::sin(path.arrival_rad) * (to.z() - kept.to_ned_m.z()) / to_mps;
  };
  LinkRow row = kept.row;
  row.budget.range_m = (to - from).norm();
  row.budget.delay_s += later_s(kept.strongest);
  row.paths_age = row.paths_age + (tick - kept.made_at);
  if (row.state != PathState::kOpen) return row;
  row.forecast.first_path_delay_s += later_s(kept.first);
  acoustics::Eigenray first;
  first.launch_angle_rad = kept.first.launch_rad;
  first.arrival_angle_rad = kept.first.arrival_rad;
  row.doppler_factor =
      doppler_factor(first, {from, now.from.velocity_ned_mps, to, now.to.velocity_ned_mps, from_mps, to_mps});
  return row;
}

void LinkRowCache::reuse(SimTime tick, Sea sea, const acoustics::Environment& environment,
                         const std::vector<PlacedVehicle>& vehicles, TableRows& rows) {
  if (reuse_distance_m_ <= 0) return;
  const std::vector<EndPair>& links = rows.links;
  rows.reused.assign(links.size(), std::nullopt);
  if (sea != sea_) clear();
  sea_ = sea;
  tick_ = tick;
  know_modems(vehicles);
  std::vector<std::optional<Kept>> before(links.size());
  std::swap(before, rows_);
  auto kept = before.begin();
  for (std::size_t i = 0; i < links.size(); ++i) {
    const auto& [from, to] = links[i];
    const auto is_earlier = [&, id = std::pair(from.id, to.id)](const std::optional<Kept>& one) {
      return !one || std::pair(one->from, one->to) < id;
    };
    while (kept != before.end() && is_earlier(*kept)) ++kept;
    if (kept == before.end()) break;
    if ((*kept)->from != from.id || (*kept)->to != to.id || !holds(**kept, links[i])) continue;
    rows.reused[i] = reused(**kept, links[i], tick, environment);
    rows_[i] = std::move(*kept);
  }
}

void LinkRowCache::keep(std::size_t index, const EndPair& ends, const Reception& reception,
                        const LinkRow& row) {
  if (reuse_distance_m_ <= 0 || reception.used == PropagationUsed::kStraightNotSearched ||
      reception.used == PropagationUsed::kStraightWithoutBottom)
    return;
  const auto& [from, to] = ends;
  Kept kept{from.id,
            to.id,
            tick_,
            from.position_ned_m,
            from.velocity_ned_mps,
            to.position_ned_m,
            to.velocity_ned_mps,
            {},
            {},
            row};
  const auto angles_of = [](const Arrival& path) {
    return Angles{path.launch_angle_rad, path.arrival_angle_rad};
  };
  const auto strongest =
      std::find_if(reception.paths.begin(), reception.paths.end(),
                   [&](const Arrival& path) { return path.delay_s == reception.budget.delay_s; });
  if (strongest != reception.paths.end()) {
    kept.strongest = angles_of(*strongest);
    kept.first = angles_of(reception.paths[first_significant(reception.paths)]);
  } else {
    const double straight_rad = acoustics::angle_down_rad(from.position_ned_m, to.position_ned_m);
    kept.strongest = kept.first = {straight_rad, straight_rad};
  }
  rows_[index] = std::move(kept);
}

}  // namespace halocline::channel_server
