#include "channel_server/propagation/seabed_profile_cache.h"

#include <algorithm>

namespace halocline::channel_server {

void SeabedProfileCache::open_tick(SimTime tick) {
  for (auto& [pair, entry] : entries_) {
    const auto holds = entry.serves() ? entry.profile : nullptr;
    const auto before = entry.held.empty() ? nullptr : entry.held.back().profile;
    if (holds != before) entry.held.push_back({tick, holds});
  }
}

std::vector<VehiclePair> SeabedProfileCache::take_geometry(const std::vector<PlacedVehicle>& vehicles,
                                                           Shard shard) {
  ++tick_;
  for (auto& [pair, entry] : entries_) entry.present = false;
  std::vector<std::pair<std::int64_t, VehiclePair>> wanted;
  for (auto low = vehicles.begin(); low != vehicles.end(); ++low) {
    for (auto high = std::next(low); high != vehicles.end(); ++high) {
      if (!shard.serves(low->id) && !shard.serves(high->id)) continue;
      Entry& entry = entries_[pair_of(low->id, high->id)];
      entry.present = true;
      entry.cells = cells_of(low->placement.position_ned_m, high->placement.position_ned_m, rule_);
      if (!entry.serves()) wanted.push_back({entry.queried_at_tick, pair_of(low->id, high->id)});
    }
  }
  std::sort(wanted.begin(), wanted.end());
  std::vector<VehiclePair> pairs;
  for (const auto& [queried_at_tick, pair] : wanted) pairs.push_back(pair);
  return pairs;
}

ProfileSurvey SeabedProfileCache::survey_of(const VehiclePair& pair) const {
  return ProfileSurvey(entries_.at(pair).cells, rule_);
}

void SeabedProfileCache::note_queried(const VehiclePair& pair) {
  const auto entry = entries_.find(pair);
  if (entry != entries_.end()) entry->second.queried_at_tick = tick_;
}

void SeabedProfileCache::store(const VehiclePair& pair, const ProfileSurvey& survey) {
  const auto entry = entries_.find(pair);
  if (entry == entries_.end() || survey.cells() != entry->second.cells) return;
  entry->second.answered_cells = survey.cells();
  entry->second.profile = survey.profile();
  entry->second.answered = true;
}

std::shared_ptr<const SeabedProfile> SeabedProfileCache::at(SimTime at, const VehiclePair& pair) const {
  const auto entry = entries_.find(pair);
  if (entry == entries_.end()) return nullptr;
  const std::vector<Held>& held = entry->second.held;
  const auto after = std::upper_bound(held.begin(), held.end(), at,
                                      [](SimTime time, const Held& one) { return time < one.from; });
  return after == held.begin() ? nullptr : std::prev(after)->profile;
}

void SeabedProfileCache::forget_before(SimTime time) {
  for (auto& [pair, entry] : entries_) {
    const auto after = std::upper_bound(entry.held.begin(), entry.held.end(), time,
                                        [](SimTime instant, const Held& one) { return instant < one.from; });
    if (after != entry.held.begin()) entry.held.erase(entry.held.begin(), std::prev(after));
  }
  std::erase_if(entries_, [&](const auto& one) {
    const std::vector<Held>& held = one.second.held;
    return !one.second.present && (held.empty() || (held.size() == 1 && held[0].from <= time));
  });
}

void SeabedProfileCache::clear() {
  tick_ = 0;
  entries_.clear();
}

}  // namespace halocline::channel_server
