// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/propagation/link_chart.h"

#include <algorithm>

#include "acoustics/reception/guard_window.h"

namespace halocline::channel_server {

void LinkChart::keep_strongest() {
  if (rows.size() <= kMaxPaths) return;
  paths_left_out = rows.size() - kMaxPaths;
  std::stable_sort(rows.begin(), rows.end(),
                   [](const Row& a, const Row& b) { return a.arrival.level > b.arrival.level; });
  rows.resize(kMaxPaths);
  std::stable_sort(rows.begin(), rows.end(),
                   [](const Row& a, const Row& b) { return a.arrival.delay_s < b.arrival.delay_s; });
}

// The two lists are sorted by delay, so one pass finds all rows.
void LinkChart::weigh(const std::vector<acoustics::Arrival>& arrivals, const acoustics::Modem& receiver) {
  if (arrivals.empty()) return;
  const acoustics::GuardWindow window = best_window(arrivals, receiver);
  std::size_t at = 0;
  for (Row& row : rows) {
    const auto is_this = [&](const acoustics::Arrival& arrival) {
      return arrival.delay_s == row.arrival.delay_s && arrival.identity == row.arrival.identity;
    };
    while (at < arrivals.size() && !is_this(arrivals[at])) ++at;
    if (at == arrivals.size()) continue;
    const double weight = window.shares[at].weight;
    row.guard_weight = weight * weight;
  }
}

}  // namespace halocline::channel_server
