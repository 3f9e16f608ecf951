// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/links/echo_plan.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace halocline::channel_server {
namespace {

PlannedSurvey survey_of(const EndPair& link) {
  const bool rising = link.from.id < link.to.id;
  const LinkEnd &low = rising ? link.from : link.to, &high = rising ? link.to : link.from;
  return {{low.id, high.id}, low.position_ned_m, high.position_ned_m};
}

bool is_before(const PlannedSurvey& a, const PlannedSurvey& b) { return a.pair < b.pair; }

// Returns each pair of the links once, sorted by pair.
std::vector<PlannedSurvey> pairs_of(const std::vector<EndPair>& links) {
  std::vector<PlannedSurvey> pairs;
  pairs.reserve(links.size());
  for (const EndPair& link : links) pairs.push_back(survey_of(link));
  std::sort(pairs.begin(), pairs.end(), is_before);
  const auto same = [](const PlannedSurvey& a, const PlannedSurvey& b) { return a.pair == b.pair; };
  pairs.erase(std::unique(pairs.begin(), pairs.end(), same), pairs.end());
  return pairs;
}

}  // namespace

std::vector<PlannedSurvey> EchoPlan::begin_tick(const std::vector<EndPair>& links) {
  ++tick_;
  const std::vector<PlannedSurvey> pairs = pairs_of(links);
  std::vector<Entry> entries;
  entries.reserve(pairs.size());
  std::vector<std::size_t> needs;
  for (const PlannedSurvey& now : pairs) {
    const Entry* kept = find(now.pair);
    entries.push_back(kept != nullptr ? *kept : Entry{now});
    const Entry& entry = entries.back();
    const bool serves = entry.is_answered &&
                        (entry.last.low_ned_m - now.low_ned_m).norm() <= rule_.reuse_distance_m &&
                        (entry.last.high_ned_m - now.high_ned_m).norm() <= rule_.reuse_distance_m;
    if (!serves) needs.push_back(entries.size() - 1);
  }
  entries_ = std::move(entries);

  const auto more_urgent = [&](std::size_t a, std::size_t b) {
    return std::tuple(entries_[a].planned, a) < std::tuple(entries_[b].planned, b);
  };
  const std::size_t count = std::min(needs.size(), rule_.surveys_per_table);
  const auto end = needs.begin() + static_cast<std::ptrdiff_t>(count);
  std::partial_sort(needs.begin(), end, needs.end(), more_urgent);
  deferred_ = needs.size() - count;
  std::vector<PlannedSurvey> planned;
  planned.reserve(count);
  for (auto need = needs.begin(); need != end; ++need) {
    planned.push_back(pairs[*need]);
    entries_[*need] = {pairs[*need], tick_, true};
  }
  return planned;
}

EchoPlan::Entry* EchoPlan::find(const VehiclePair& pair) {
  const auto found = std::lower_bound(entries_.begin(), entries_.end(), pair,
                                      [](const Entry& a, const VehiclePair& b) { return a.last.pair < b; });
  return found != entries_.end() && found->last.pair == pair ? &*found : nullptr;
}

void EchoPlan::note_unanswered(const VehiclePair& pair) {
  if (Entry* entry = find(pair)) entry->is_answered = false;
}

void EchoPlan::clear() {
  tick_ = 0;
  entries_.clear();
  deferred_ = 0;
}

}  // namespace halocline::channel_server
