// SPDX-License-Identifier: BSD-3-Clause
#include "runs/timeline/run_summary.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "runs/timeline/delivery.h"
#include "runs/timeline/node_health.h"
#include "runs/timeline/outcome_ledger.h"
#include "runs/timeline/packet_book.h"
#include "runs/timeline/plan_texts.h"
#include "runs/timeline/vehicle_record.h"

namespace halocline::clients {
namespace {

constexpr std::size_t kRowsEach = 6;
constexpr auto kReceived = static_cast<std::size_t>(packet_outcome_t::RECEIVED);

std::string distance(double metres) {
  return metres < 1000 ? fmt::format("{:.0f} m", metres) : fmt::format("{:.2f} km", metres / 1000);
}

std::string share(std::int64_t part, std::int64_t all) {
  return fmt::format("{} of {} ({:.0f} %)", part, all,
                     100.0 * static_cast<double>(part) / static_cast<double>(all));
}

std::pair<double, double> depths_m(const VehicleRecord& vehicle) {
  const auto [least, greatest] = std::minmax_element(
      vehicle.track.all().begin(), vehicle.track.all().end(),
      [](const auto& a, const auto& b) { return a.value.position_ned_m.z() < b.value.position_ned_m.z(); });
  return {least->value.position_ned_m.z(), greatest->value.position_ned_m.z()};
}

std::string way(const VehicleRecord& vehicle) {
  const auto [least_m, greatest_m] = depths_m(vehicle);
  if (vehicle.is_at_rest()) return fmt::format("stayed at {:.0f} m of depth", whole_number(least_m));
  std::string text = fmt::format("went {}, {:.0f} to {:.0f} m deep", distance(vehicle.distance_m()),
                                 whole_number(least_m), whole_number(greatest_m));
  if (!vehicle.plans.empty()) text += "; " + progress_text(vehicle.plans.back().value);
  return text;
}

void add_vehicles(const RunTimeline& timeline, std::vector<SummaryRow>& rows) {
  std::vector<const VehicleRecord*> with_track;
  for (const VehicleRecord& vehicle : timeline.vehicles()) {
    if (!vehicle.track.empty()) with_track.push_back(&vehicle);
  }
  if (with_track.empty()) {
    rows.push_back({"vehicles", "none published a state"});
    return;
  }
  if (with_track.size() <= kRowsEach) {
    for (const VehicleRecord* vehicle : with_track) rows.push_back({vehicle->name, way(*vehicle)});
    return;
  }
  double longest_m = 0, sum_m = 0;
  std::int64_t at_rest = 0;
  for (const VehicleRecord* vehicle : with_track) {
    longest_m = std::max(longest_m, vehicle->distance_m());
    sum_m += vehicle->distance_m();
    at_rest += vehicle->is_at_rest() ? 1 : 0;
  }
  rows.push_back({"vehicles", fmt::format("{}, {} at rest; they went {}, the farthest {}", with_track.size(),
                                          at_rest, distance(sum_m), distance(longest_m))});
}

// Packets between two vehicles, both directions together.
struct Both {
  std::string names;
  std::int64_t packets = 0, received = 0;
};

void add_pairs(const RunTimeline& timeline, std::vector<SummaryRow>& rows) {
  std::map<std::pair<std::int32_t, std::int32_t>, Both> pairs;
  for (const auto& [ids, counts] : timeline.ledger().by_pair()) {
    const auto ordered = std::minmax(ids.first, ids.second);
    Both& both = pairs[ordered];
    both.names = timeline.name(ordered.first) + " and " + timeline.name(ordered.second);
    both.packets += sum(counts);
    both.received += counts[kReceived];
  }
  if (pairs.empty()) return;
  const char* key = "received";
  if (pairs.size() <= kRowsEach) {
    for (const auto& [ids, both] : pairs) {
      rows.push_back({key, "between " + both.names + ": " + share(both.received, both.packets)});
      key = "";
    }
    return;
  }
  const auto in_contact =
      std::count_if(pairs.begin(), pairs.end(), [](const auto& pair) { return pair.second.received > 0; });
  rows.push_back({key, fmt::format("between {} of {} pairs", in_contact, pairs.size())});
}

// Adds the reasons of losses that noise or interference decided, the most frequent first, and the bytes that
// were right, where they are fewer than those of the packets received.
void add_reasons(const OutcomeLedger& ledger, std::vector<SummaryRow>& rows) {
  std::vector<std::pair<std::int64_t, std::size_t>> reasons;
  for (std::size_t reason = 1; reason < kLossReasons; ++reason) {
    if (ledger.by_reason()[reason] > 0) reasons.emplace_back(-ledger.by_reason()[reason], reason);
  }
  std::sort(reasons.begin(), reasons.end());
  std::string text;
  for (const auto& [count, reason] : reasons)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", -count, loss_reason_name(reason));
  if (!text.empty()) rows.push_back({"lost to", text});
  if (ledger.bytes().sent > 0)
    rows.push_back({"bytes right", share(ledger.bytes().good, ledger.bytes().sent)});
}

void add_packets(const RunTimeline& timeline, std::vector<SummaryRow>& rows) {
  std::int64_t transmitted = 0;
  std::map<std::int8_t, std::int64_t> refused;
  for (const PacketRecord& packet : timeline.packets().all()) {
    if (packet.is_refused())
      ++refused[*packet.receipt];
    else if (packet.departure)
      ++transmitted;
  }
  const OutcomeCounts& counts = timeline.ledger().total();
  const std::int64_t all = sum(counts), lost = all - counts[kReceived];
  if (transmitted == 0 && all == 0 && refused.empty()) {
    rows.push_back({"packets", "none"});
    return;
  }
  std::string text = fmt::format("{} transmitted", transmitted);
  if (all > 0) text += ", received " + share(counts[kReceived], all) + " times at other vehicles";
  for (const auto& [result, count] : refused)
    text += fmt::format("; {} {}", count, receipt_name(static_cast<std::size_t>(result)));
  rows.push_back({"packets", text});
  add_pairs(timeline, rows);
  if (lost == 0) return;
  std::vector<std::pair<std::int64_t, std::size_t>> causes;
  for (std::size_t outcome = 0; outcome < kOutcomes; ++outcome) {
    if (outcome != kReceived && counts[outcome] > 0) causes.emplace_back(-counts[outcome], outcome);
  }
  std::sort(causes.begin(), causes.end());
  text.clear();
  for (const auto& [count, outcome] : causes)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", -count, outcome_name(outcome));
  rows.push_back({"lost", text});
  add_reasons(timeline.ledger(), rows);
}

// Adds the programs whose results went out later than the scenario allows, the latest first.
void add_lateness(const RunTimeline& timeline, std::vector<SummaryRow>& rows) {
  std::vector<std::pair<double, std::string>> late;
  for (const auto& [name, node] : timeline.health().nodes()) {
    if (!node.held_real_time()) late.emplace_back(node.lateness_max_s, name);
  }
  if (late.empty()) return;
  std::sort(late.rbegin(), late.rend());
  std::string text = "real time was not kept: results up to";
  for (std::size_t i = 0; i < std::min(late.size(), kRowsEach); ++i)
    text += fmt::format("{} {:.2g} s late from {}", i == 0 ? "" : ",", late[i].first, late[i].second);
  if (late.size() > kRowsEach) text += fmt::format(" and {} more", late.size() - kRowsEach);
  rows.push_back({"time", text});
}

// Adds the share of outcomes whose sound met a bottom beyond the known terrain.
void add_terrain(const RunTimeline& timeline, std::vector<SummaryRow>& rows) {
  const PropagationCounts& counts = timeline.ledger().by_propagation();
  const std::int64_t beyond = counts[static_cast<std::size_t>(packet_outcome_t::RAYS_BEYOND_TERRAIN)];
  if (beyond == 0) return;
  const std::int64_t all = std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
  const bool is_held = timeline.ledger().total()[static_cast<std::size_t>(packet_outcome_t::NO_TERRAIN)] == 0;
  rows.push_back({"terrain", share(beyond, all) + " outcomes lie where the terrain ends or has no data: " +
                                 (is_held ? "its last known depth was held for sound"
                                          : "no sound passes there (propagation.beyond = \"none\")")});
}

}  // namespace

std::vector<SummaryRow> run_summary(const RunTimeline& timeline) {
  std::vector<SummaryRow> rows;
  add_vehicles(timeline, rows);
  add_packets(timeline, rows);
  add_lateness(timeline, rows);
  add_terrain(timeline, rows);
  return rows;
}

}  // namespace halocline::clients
