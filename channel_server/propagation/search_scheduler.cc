// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/propagation/search_scheduler.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "channel_server/propagation/path_reuse.h"
#include "core/elementary.h"

namespace halocline::channel_server {
namespace {

constexpr double kNeverSearched = 2000, kOtherSea = 1000;  // dB of urgency: more than any level
constexpr double kUsualChange = 25, kMinChange = 1e-3;     // m

double change_m(const PathQuery& a, const PathQuery& b) {
  const auto moved = [&](std::size_t i) { return b.places[i] - a.places[i]; };
  return elementary::hypot(moved(0), moved(1)) + elementary::hypot(moved(2), moved(3)) +
         std::abs(b.link.range_m - a.link.range_m) +
         kDepthsCount * (std::abs(b.link.source_depth_m - a.link.source_depth_m) +
                         std::abs(b.link.receiver_depth_m - a.link.receiver_depth_m));
}

double urgency(const SearchScheduler::Wanted& wanted, const SearchScheduler::Scheduled* last) {
  if (last == nullptr) return wanted.excess_db + kNeverSearched;
  if (!is_of_one_sea(last->query, wanted.query)) return wanted.excess_db + kOtherSea;
  const double change = std::max(change_m(last->query, wanted.query), kMinChange);
  return wanted.excess_db + 20 * elementary::log10(change / kUsualChange);
}

}  // namespace

SearchScheduler::LinkId SearchScheduler::id_of(const EndPair& ends) {
  const auto [low, high] = std::minmax(ends.from.id, ends.to.id);
  return {low, high, ends.from.modem->centre_frequency_hz};
}

void SearchScheduler::begin_tick(SimTime tick, std::vector<Wanted> links) {
  if (tick < tick_) ids_.clear();
  tick_ = tick;
  const auto before = [](const Wanted& a, const Wanted& b) { return a.id < b.id; };
  if (!std::is_sorted(links.begin(), links.end(), before))
    std::stable_sort(links.begin(), links.end(), before);
  const auto same = [](const Wanted& a, const Wanted& b) { return a.id == b.id; };
  links.erase(std::unique(links.begin(), links.end(), same), links.end());

  struct Need {
    double urgency;
    std::size_t link;
  };
  std::vector<Need> needs;
  std::vector<Scheduled*> kept;  // for each link; null: never scheduled
  for (std::size_t i = 0; i < links.size(); ++i) {
    kept.push_back(find(links[i].id));
    if (kept[i] != nullptr && kept[i]->query.key() == links[i].query.key())
      kept[i]->current_at = tick;
    else
      needs.push_back({urgency(links[i], kept[i]), i});
  }
  const auto more_urgent = [](const Need& a, const Need& b) {
    return a.urgency != b.urgency ? a.urgency > b.urgency : a.link < b.link;
  };
  const auto last = needs.begin() + static_cast<std::ptrdiff_t>(std::min(needs.size(), searches_));
  std::partial_sort(needs.begin(), last, needs.end(), more_urgent);
  std::vector<bool> is_scheduled(links.size());
  std::for_each(needs.begin(), last, [&](const Need& need) { is_scheduled[need.link] = true; });

  std::vector<LinkId> ids;
  std::vector<Scheduled> scheduled;
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (!is_scheduled[i] && kept[i] == nullptr) continue;
    ids.push_back(links[i].id);
    scheduled.push_back(is_scheduled[i] ? Scheduled{std::move(links[i].query), tick, nullptr}
                                        : std::move(*kept[i]));
  }
  ids_ = std::move(ids);
  scheduled_ = std::move(scheduled);
}

SearchScheduler::Scheduled* SearchScheduler::find(const LinkId& id) {
  const auto found = std::lower_bound(ids_.begin(), ids_.end(), id);
  if (found == ids_.end() || *found != id) return nullptr;
  return &scheduled_[static_cast<std::size_t>(found - ids_.begin())];
}

}  // namespace halocline::channel_server
