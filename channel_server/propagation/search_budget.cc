#include "channel_server/propagation/search_budget.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/elementary.h"

namespace halocline::channel_server {
namespace {

constexpr double kNeverSearched = 2000, kOtherSea = 1000;  // dB of urgency: more than any level has
constexpr double kUsualChange = 25, kLeastChange = 1e-3;   // m
constexpr double kDepthsCount = 10;

double change_m(const PathQuery& a, const PathQuery& b) {
  const auto moved = [&](std::size_t i) { return b.places[i] - a.places[i]; };
  return elementary::hypot(moved(0), moved(1)) + elementary::hypot(moved(2), moved(3)) +
         std::abs(b.link.range_m - a.link.range_m) +
         kDepthsCount * (std::abs(b.link.source_depth_m - a.link.source_depth_m) +
                         std::abs(b.link.receiver_depth_m - a.link.receiver_depth_m));
}

double urgency(const SearchBudget::Wanted& wanted, const SearchBudget::Granted* last) {
  if (last == nullptr) return wanted.excess_db + kNeverSearched;
  if (!is_of_one_sea(last->query, wanted.query)) return wanted.excess_db + kOtherSea;
  const double change = std::max(change_m(last->query, wanted.query), kLeastChange);
  return wanted.excess_db + 20 * elementary::log10(change / kUsualChange);
}

}  // namespace

SearchBudget::LinkId SearchBudget::id_of(const EndPair& ends) {
  const auto [low, high] = std::minmax(ends.from.id, ends.to.id);
  return {low, high, ends.from.modem->centre_frequency_hz};
}

void SearchBudget::begin_tick(SimTime tick, const std::vector<Wanted>& links) {
  if (tick < tick_) granted_.clear();
  tick_ = tick;
  struct Need {
    double urgency;
    const Wanted* wanted;
  };
  std::map<LinkId, Granted> kept;
  std::map<LinkId, const Wanted*> seen;
  std::vector<Need> needs;
  for (const Wanted& wanted : links) {
    if (!seen.emplace(wanted.id, &wanted).second) continue;
    const auto last = granted_.find(wanted.id);
    const bool known = last != granted_.end();
    if (known && last->second.query.key() == wanted.query.key()) {
      last->second.current_at = tick;
    } else {
      needs.push_back({urgency(wanted, known ? &last->second : nullptr), &wanted});
    }
    if (known) kept.emplace(wanted.id, std::move(last->second));
  }
  std::sort(needs.begin(), needs.end(), [](const Need& a, const Need& b) {
    return a.urgency != b.urgency ? a.urgency > b.urgency : a.wanted->id < b.wanted->id;
  });
  if (needs.size() > searches_) needs.resize(searches_);
  for (const Need& need : needs)
    kept.insert_or_assign(need.wanted->id, Granted{need.wanted->query, tick, nullptr});
  granted_ = std::move(kept);
}

SearchBudget::Granted* SearchBudget::find(const LinkId& id) {
  const auto found = granted_.find(id);
  return found == granted_.end() ? nullptr : &found->second;
}

}  // namespace halocline::channel_server
