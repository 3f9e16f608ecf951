// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/vehicles/unlisted_vehicles.h"

#include "core/check.h"

namespace halocline::channel_server {

std::string UnlistedVehicles::admit(std::string_view name, VehicleId id, SimTime time) {
  if (tracked_ >= kMaxTracked) {
    return "too many vehicles; at most " + std::to_string(kMaxTracked) +
           " that are not of the scenario are tracked";
  }
  if (tracked_ >= kMaxAtOnce && !is_steady(name, {id, time})) {
    return "first STATE of a vehicle; beyond " + std::to_string(kMaxAtOnce) +
           " that are not of the scenario, one is tracked from its second STATE on";
  }
  ++tracked_;
  return {};
}

bool UnlistedVehicles::is_steady(std::string_view name, const Candidate& now) {
  const std::string key(name);
  const Candidate* before = candidates_.find(key);
  const bool steady = before != nullptr && before->id == now.id && before->time != now.time &&
                      now.time - before->time <= timeout_ && before->time - now.time <= timeout_;
  if (!steady) candidates_.insert(key, now);
  return steady;
}

void UnlistedVehicles::leave() {
  ensure(tracked_ > 0, "an unlisted vehicle leaves that is not tracked");
  --tracked_;
}

}  // namespace halocline::channel_server
