// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/links/multipath_cache.h"

#include <utility>

namespace halocline::channel_server {

bool MultipathCache::serves(const Entry& entry, const Vec3& low, const Vec3& high) const {
  return (entry.survey.from_ned_m() - low).norm() <= reuse_distance_m_ &&
         (entry.survey.to_ned_m() - high).norm() <= reuse_distance_m_;
}

Multipath MultipathCache::at_last_tick(SimTime at, const PlacedVehicle& transmitter,
                                       const PlacedVehicle& receiver, Propagation& propagation) {
  const auto from = places_.find(transmitter.id), to = places_.find(receiver.id);
  if (from == places_.end() || to == places_.end()) return Multipath::kUnknown;
  return look_up(at, transmitter, receiver, from->second, to->second, propagation);
}

Multipath MultipathCache::at(SimTime at, const PlacedVehicle& transmitter, const PlacedVehicle& receiver,
                             Propagation& propagation) {
  return look_up(at, transmitter, receiver, transmitter.placement.position_ned_m,
                 receiver.placement.position_ned_m, propagation);
}

Multipath MultipathCache::look_up(SimTime at, const PlacedVehicle& transmitter, const PlacedVehicle& receiver,
                                  const Vec3& from, const Vec3& to, Propagation& propagation) {
  const auto entry = entries_.find(pair_of(transmitter.id, receiver.id));
  if (entry == entries_.end()) return Multipath::kUnknown;
  const bool rising = transmitter.id < receiver.id;
  if (!serves(entry->second, rising ? from : to, rising ? to : from)) return Multipath::kUnknown;
  return verdict_of(entry->second, at, transmitter, receiver, propagation);
}

// Computing a verdict costs as much as a dozen links. Modems change rarely, so each verdict is stored with
// its survey.
Multipath MultipathCache::verdict_of(Entry& entry, SimTime at, const PlacedVehicle& transmitter,
                                     const PlacedVehicle& receiver, Propagation& propagation) {
  const bool reversed = transmitter.id > receiver.id;
  Verdict& verdict = entry.verdicts[reversed ? 1 : 0];
  const acoustics::Modem &from = transmitter.modem->modem, &to = receiver.modem->modem;
  if (!verdict.known || !(verdict.transmitter == from) || !(verdict.receiver == to)) {
    verdict = {from, to, multipath_of(entry.survey, reversed, at, propagation, from, to), true};
  }
  return verdict.multipath;
}

void MultipathCache::begin_tick(const std::vector<PlacedVehicle>& vehicles) {
  places_.clear();
  for (const auto& vehicle : vehicles) places_.emplace(vehicle.id, vehicle.placement.position_ned_m);
  std::erase_if(entries_, [&](const auto& entry) {
    return !places_.contains(entry.first.first) || !places_.contains(entry.first.second);
  });
}

void MultipathCache::store(const VehiclePair& pair, EchoSurvey survey) {
  // One of the two vehicles has left.
  if (!places_.contains(pair.first) || !places_.contains(pair.second)) return;
  entries_[pair] = {std::move(survey), {}};
}

void MultipathCache::forget_verdicts() {
  for (auto& [pair, entry] : entries_) entry.verdicts[0] = entry.verdicts[1] = Verdict();
}

void MultipathCache::clear() {
  places_.clear();
  entries_.clear();
}

}  // namespace halocline::channel_server
