// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/clocks/vehicle_time.h"

#include <algorithm>
#include <cstddef>

#include "bus/messages/channels.h"
#include "bus/messages/messages.h"
#include "bus/transport/subscription.h"

namespace halocline::clients {
namespace {

// Fixes kept of each vehicle for a node that is restarted: the latest one, and those that do not apply yet.
constexpr std::size_t kFixesKept = 16;
// Bound on the rate of a clock, s/s; only its random walk may exceed it (VehicleClocks).
constexpr double kFastest = 1.001;

SimTime whole_microsecond_from(SimTime time) {
  return SimTime::from_utime((time + SimDuration::from_nanoseconds(499)).to_utime());
}

channel_server::VehicleClocks clocks_of(const ClockSetConfig& config) {
  return {config.clocks, config.seed, config.fix_lag};
}

}  // namespace

VehicleTime::VehicleTime(bus::Bus& bus, const ClockSetConfig& config)
    : config_(config), clocks_(clocks_of(config)) {
  for (const channel_server::ClockOf& clock : config.clocks) {
    owners_.emplace(clock.id, clock.vehicle);
    if (!clock.settings.is_set_by_gps) continue;
    bus.subscribe<vehicle_gps_t>(
        bus::channels::kGps.of(clock.vehicle),
        [this, id = clock.id](const vehicle_gps_t& fix) { add_fix(id, SimTime::from_utime(fix.utime)); },
        bus::Wakeup::kMayAdvanceDue);
  }
}

void VehicleTime::add_fix(std::int32_t vehicle_id, SimTime fix) {
  clocks_.add_fix(owners_.at(vehicle_id), fix);
  std::set<SimTime>& sets = sets_[vehicle_id];
  sets.insert(fix + config_.fix_lag);
  if (sets.size() > kFixesKept) sets.erase(sets.begin());
}

const std::set<SimTime>& VehicleTime::sets_of(std::int32_t vehicle_id) const {
  static const std::set<SimTime> kNone;
  const auto found = sets_.find(vehicle_id);
  return found == sets_.end() ? kNone : found->second;
}

SimTime VehicleTime::shown(std::int32_t vehicle_id, SimTime at) const {
  return has_clock(vehicle_id) ? at + SimDuration::from_seconds(clocks_.error_s(vehicle_id, at)) : at;
}

// Advances by steps in which the clock cannot have passed the wanted reading, of at least a microsecond. If
// its random walk runs ahead meanwhile, the result is late. A received fix sets the clock within the lag, so
// the first step ends there at the latest.
SimTime VehicleTime::due(std::int32_t vehicle_id, SimTime shown_time) const {
  const bool is_instant = shown_time != SimTime::never() && shown_time != SimTime::at_once();
  if (!is_instant || !has_clock(vehicle_id)) return shown_time;
  constexpr double kMicrosecond_s = 1e-6;
  const SimTime set = now_ + config_.fix_lag;
  SimTime at = now_;
  for (double left_s = (shown_time - shown(vehicle_id, at)).seconds(); left_s > 0;
       left_s = (shown_time - shown(vehicle_id, at)).seconds()) {
    const SimTime next = at + SimDuration::from_seconds(std::max(left_s / kFastest, kMicrosecond_s));
    at = whole_microsecond_from(at < set ? std::min(next, set) : next);
  }
  return at;
}

SimDuration VehicleTime::set_by(std::int32_t vehicle_id, SimTime from, SimTime to) const {
  constexpr SimDuration kBefore = SimDuration::from_nanoseconds(1);
  const std::set<SimTime>& sets = sets_of(vehicle_id);
  SimDuration sum;
  for (auto at = sets.upper_bound(from); at != sets.end() && *at <= to; ++at)
    sum = sum + (shown(vehicle_id, *at) - shown(vehicle_id, *at - kBefore)) - kBefore;
  return sum;
}

SimTime VehicleTime::next_set(std::int32_t vehicle_id) const {
  const std::set<SimTime>& sets = sets_of(vehicle_id);
  const auto at = sets.upper_bound(now_);
  return at == sets.end() ? SimTime::never() : *at;
}

SimTime VehicleTime::instant_of(std::int32_t vehicle_id, SimTime shown_time, SimTime now) const {
  return now - (shown(vehicle_id, now) - shown_time);
}

void VehicleTime::restart(SimTime now) {
  clocks_ = clocks_of(config_);
  sets_.clear();
  now_ = now;
}

void VehicleTime::archive(Archive& a) {
  a(sets_, now_);
  if (!a.is_loading()) return;
  for (const auto& [vehicle_id, vehicle] : owners_) {
    for (const SimTime set : sets_of(vehicle_id)) clocks_.add_fix(vehicle, set - config_.fix_lag);
  }
}

}  // namespace halocline::clients
