// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/vehicles/vehicle_clocks.h"

#include <algorithm>

#include "core/check.h"
#include "core/random.h"

namespace halocline::channel_server {

VehicleClocks::VehicleClocks(const std::vector<ClockOf>& clocks, std::uint64_t seed, SimDuration fix_lag)
    : seed_(seed), fix_lag_(fix_lag) {
  constexpr std::uint32_t kWalk = purpose_of("clock-walk");
  for (const auto& [vehicle, id, settings] : clocks) {
    require_in_range(settings.offset_s, -1e5, 1e5, "offset of a clock", "s");
    require_in_range(settings.drift, -1e-3, 1e-3, "drift of a clock");
    require_in_range(settings.random_walk, 0, 1e-3, "random walk of a clock", "s/sqrt(s)");
    require_in_range(settings.gps_residual_s, 0, 1, "residual of a clock set by GPS", "s");
    const DrawAddress address{.seed = seed, .purpose = kWalk, .who = static_cast<std::uint32_t>(id)};
    clocks_.emplace(id,
                    Clock{vehicle, settings, GaussMarkovProcess::random_walk(settings.random_walk, address)});
  }
}

bool VehicleClocks::need_fixes() const {
  return std::any_of(clocks_.begin(), clocks_.end(),
                     [](const auto& entry) { return entry.second.settings.is_set_by_gps; });
}

void VehicleClocks::add_fix(std::string_view vehicle, SimTime at) {
  const auto found = std::find_if(clocks_.begin(), clocks_.end(),
                                  [&](const auto& entry) { return entry.second.vehicle == vehicle; });
  if (found == clocks_.end() || !found->second.settings.is_set_by_gps) return;
  found->second.fix.set(at, at);
}

double VehicleClocks::residual_s(VehicleId id, const Clock& clock, SimTime fix) const {
  constexpr std::uint32_t kResidual = purpose_of("clock-gps");
  return clock.settings.gps_residual_s * normal_at({.seed = seed_,
                                                    .purpose = kResidual,
                                                    .who = static_cast<std::uint32_t>(id),
                                                    .which = static_cast<std::uint64_t>(fix.nanoseconds())});
}

double VehicleClocks::error_s(VehicleId id, SimTime at) const {
  const auto found = clocks_.find(id);
  if (found == clocks_.end()) return 0;
  const Clock& clock = found->second;
  const double walk_s = clock.walk.at(at);
  const std::optional<SimTime> fix = clock.fix.at(at - fix_lag_);
  if (!fix) {
    return clock.settings.offset_s + clock.settings.drift * (at - SimTime()).seconds() + walk_s;
  }
  const SimTime set = *fix + fix_lag_;
  return residual_s(id, clock, *fix) + clock.settings.drift * (at - set).seconds() + walk_s -
         clock.walk.at(set);
}

void VehicleClocks::forget_before(SimTime time) {
  for (auto& [id, clock] : clocks_) clock.fix.forget_before(time - fix_lag_);
}

}  // namespace halocline::channel_server
