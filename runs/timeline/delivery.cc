// SPDX-License-Identifier: BSD-3-Clause
#include "runs/timeline/delivery.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/elementary.h"
#include "core/sim_time.h"
#include "runs/timeline/packet_book.h"

namespace halocline::clients {
namespace {

constexpr auto kReceivedOutcome = static_cast<std::size_t>(packet_outcome_t::RECEIVED);
constexpr std::size_t kSnrSamples = 2000;
const SimDuration kFreshTable = SimDuration::from_seconds(10);

std::optional<double> median(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::optional<double> median_snr_db(const RunTimeline& timeline, std::int32_t from_id, std::int32_t to_id,
                                    const std::vector<double>& of_outcomes) {
  std::vector<double> values;
  for (const auto& entry : timeline.links().history(from_id, to_id, *link_column("snr_db"),
                                                    SimTime::at_once(), SimTime::never(), kSnrSamples))
    values.push_back(entry.value);
  return median(values.empty() ? of_outcomes : values);
}

// Returns the delivery probability in the last link table before the departure; empty when there is no table,
// or only one older than kFreshTable.
std::optional<double> predicted(const RunTimeline& timeline, const packet_outcome_t& o) {
  const SimTime departure = SimTime::from_utime(o.departure_utime);
  const link_t* row = timeline.links().row_at(o.source_id, o.receiver_id, departure, kFreshTable);
  return row == nullptr ? std::nullopt : std::optional(row->delivery_probability);
}

}  // namespace

std::vector<PairDelivery> delivery_by_pair(const RunTimeline& timeline) {
  std::map<OutcomeLedger::Pair, std::vector<double>> snr_of_outcomes;
  for (const PacketRecord& packet : timeline.packets().all()) {
    for (const packet_outcome_t& o : packet.outcomes) {
      if (o.num_paths > 0) snr_of_outcomes[{o.source_id, o.receiver_id}].push_back(o.snr_db);
    }
  }
  std::vector<PairDelivery> pairs;
  for (const auto& [pair, counts] : timeline.ledger().by_pair()) {
    const auto [from_id, to_id] = pair;
    pairs.push_back({from_id, to_id, sum(counts), counts[kReceivedOutcome],
                     median_snr_db(timeline, from_id, to_id, snr_of_outcomes[pair])});
  }
  return pairs;
}

double round_step(double least) {
  const double power = elementary::exp10(std::floor(elementary::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= least * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

std::vector<RangeDelivery> delivery_by_range(const RunTimeline& timeline, std::size_t max_steps) {
  double greatest_m = 1;
  for (const PacketRecord& packet : timeline.packets().all()) {
    for (const packet_outcome_t& o : packet.outcomes) greatest_m = std::max(greatest_m, o.range_m);
  }
  const double step_m = round_step(greatest_m / static_cast<double>(max_steps) * 1.000001);
  struct Sum {
    std::int64_t packets = 0, received = 0, predictions = 0;
    double predicted = 0;
  };
  std::map<std::int64_t, Sum> sums;
  for (const PacketRecord& packet : timeline.packets().all()) {
    for (const packet_outcome_t& o : packet.outcomes) {
      Sum& at = sums[static_cast<std::int64_t>(std::floor(o.range_m / step_m))];
      ++at.packets;
      at.received += o.outcome == packet_outcome_t::RECEIVED ? 1 : 0;
      const auto probability = predicted(timeline, o);
      at.predictions += probability ? 1 : 0;
      at.predicted += probability.value_or(0);
    }
  }
  std::vector<RangeDelivery> ranges;
  for (const auto& [number, at] : sums) {
    RangeDelivery range{static_cast<double>(number) * step_m, static_cast<double>(number + 1) * step_m,
                        at.packets, at.received, std::nullopt};
    if (at.predictions > 0) range.predicted = at.predicted / static_cast<double>(at.predictions);
    ranges.push_back(range);
  }
  return ranges;
}

}  // namespace halocline::clients
