// SPDX-License-Identifier: BSD-3-Clause
// Output of an outcome summary as text, JSON, CSV and a plot.
#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/ostream.h>
#include <nlohmann/json.hpp>

#include "core/csv_table.h"
#include "runs/analysis/energy_cost.h"
#include "runs/analysis/outcome_summary.h"
#include "runs/plot/plot.h"
#include "runs/timeline/outcome_ledger.h"
#include "runs/timeline/packet_reasons.h"

namespace halocline::clients {
namespace {

std::vector<std::size_t> outcomes_in(const OutcomeSummary& summary) {
  std::vector<std::size_t> outcomes;
  for (std::size_t outcome = 0; outcome < kOutcomes; ++outcome) {
    if (summary.total()[outcome] > 0) outcomes.push_back(outcome);
  }
  return outcomes;
}

std::size_t column_width(std::size_t outcome) {
  return std::max<std::size_t>(9, std::string_view(outcome_name(outcome)).size() + 2);
}

// Prints one row of counts below the heading of outcomes.
void print_row(std::ostream& out, const std::string& title, const OutcomeCounts& counts,
               const std::vector<std::size_t>& outcomes) {
  fmt::print(out, "{:<26}{:>9}", title, sum(counts));
  for (const std::size_t outcome : outcomes)
    fmt::print(out, "{:>{}}", counts[outcome], column_width(outcome));
  out << "\n";
}

void print_heading(std::ostream& out, const char* title, const std::vector<std::size_t>& outcomes) {
  fmt::print(out, "\n{:<26}{:>9}", title, "all");
  for (const std::size_t outcome : outcomes)
    fmt::print(out, "{:>{}}", outcome_name(outcome), column_width(outcome));
  out << "\n";
}

double in_seconds(std::int64_t utime) { return static_cast<double>(utime) * 1e-6; }

nlohmann::ordered_json to_json(const OutcomeCounts& counts) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (std::size_t outcome = 0; outcome < counts.size(); ++outcome) {
    if (counts[outcome] > 0) json[outcome_name(outcome)] = counts[outcome];
  }
  return json;
}

void print_energy(std::ostream& out, const OutcomeSummary& summary) {
  const EnergyCosts costs = energy_costs(summary.outcomes());
  if (costs.empty()) return;
  fmt::print(out, "\n{:<26}{:>9}{:>10}{:>9}{:>14}{:>14}{:>10}\n", "energy: from, up to m", "packets",
             "received", "bytes", "transmit, J", "receive, J", "J/byte");
  for (const auto& [key, cost] : costs) {
    fmt::print(out, "{:<26}{:>9}{:>10}{:>9}{:>14.3f}{:>14.3f}{:>10}\n",
               fmt::format("{}, {:.0f}", summary.name(key.first), key.second), cost.packets, cost.received,
               cost.bytes, cost.transmit_j, cost.receive_j,
               cost.bytes > 0 ? fmt::format("{:.4f}", cost.per_byte_j()) : "-");
  }
}

nlohmann::ordered_json to_json(const EnergyCosts& costs, const OutcomeSummary& summary) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const auto& [key, cost] : costs) {
    json.push_back({{"from", summary.name(key.first)},
                    {"up_to_m", key.second},
                    {"packets", cost.packets},
                    {"received", cost.received},
                    {"bytes", cost.bytes},
                    {"transmit_j", cost.transmit_j},
                    {"receive_j", cost.receive_j}});
    if (cost.bytes > 0) json.back()["joules_per_byte"] = cost.per_byte_j();
  }
  return json;
}

}  // namespace

void print(std::ostream& out, const OutcomeSummary& summary, const std::string& coverage) {
  const std::int64_t all = sum(summary.total());
  const auto outcomes = outcomes_in(summary);
  fmt::print(out, "{} outcomes{}\n", all, coverage);
  for (const std::size_t outcome : outcomes) {
    const std::int64_t count = summary.total()[outcome];
    fmt::print(out, "  {:<24}{:>9}{:>8.1f} %\n", outcome_name(outcome), count,
               100.0 * static_cast<double>(count) / static_cast<double>(all));
  }
  for (std::size_t reason = 1; reason < kLossReasons; ++reason) {
    const std::int64_t count = summary.by_reason()[reason];
    if (count == 0) continue;
    fmt::print(out, "  {:<24}{:>9}{:>8.1f} %\n", fmt::format("lost to {}", loss_reason_name(reason)), count,
               100.0 * static_cast<double>(count) / static_cast<double>(all));
  }
  if (const ByteCounts& bytes = summary.bytes(); bytes.sent > 0) {
    fmt::print(out, "  {:<24}{:>9}{:>8.1f} % of {}\n", "bytes right", bytes.good,
               100.0 * static_cast<double>(bytes.good) / static_cast<double>(bytes.sent), bytes.sent);
  }
  for (std::size_t propagation = 0; propagation < kPropagations; ++propagation) {
    const std::int64_t count = summary.by_propagation()[propagation];
    if (count == 0) continue;
    fmt::print(out, "  {:<24}{:>9}{:>8.1f} %\n", fmt::format("paths: {}", propagation_name(propagation)),
               count, 100.0 * static_cast<double>(count) / static_cast<double>(all));
  }
  if (summary.repeated() > 0) fmt::print(out, "{} repetitions were left out\n", summary.repeated());
  if (all == 0) return;
  print_heading(out, "from -> to", outcomes);
  for (const auto& [pair, counts] : summary.by_pair())
    print_row(out, summary.name(pair.first) + " -> " + summary.name(pair.second), counts, outcomes);
  print_heading(out, "departure from, s", outcomes);
  for (const auto& [start, counts] : summary.by_window())
    print_row(out, fmt::format("{:.3f}", in_seconds(start)), counts, outcomes);
  print_energy(out, summary);
}

namespace {

ByteCounts bytes_of(const OutcomeSummary& summary, const OutcomeLedger::Pair& pair) {
  const auto found = summary.bytes_by_pair().find(pair);
  return found != summary.bytes_by_pair().end() ? found->second : ByteCounts{};
}

}  // namespace

std::string to_json(const OutcomeSummary& summary) {
  nlohmann::ordered_json json;
  json["outcomes"] = sum(summary.total());
  json["repeated"] = summary.repeated();
  json["by_outcome"] = to_json(summary.total());
  json["by_reason"] = nlohmann::ordered_json::object();
  for (std::size_t reason = 1; reason < kLossReasons; ++reason) {
    const std::int64_t count = summary.by_reason()[reason];
    if (count > 0) json["by_reason"][loss_reason_name(reason)] = count;
  }
  json["bytes_sent"] = summary.bytes().sent;
  json["bytes_good"] = summary.bytes().good;
  json["by_propagation"] = nlohmann::ordered_json::object();
  for (std::size_t propagation = 0; propagation < kPropagations; ++propagation) {
    const std::int64_t count = summary.by_propagation()[propagation];
    if (count > 0) json["by_propagation"][propagation_name(propagation)] = count;
  }
  json["pairs"] = nlohmann::ordered_json::array();
  for (const auto& [pair, counts] : summary.by_pair()) {
    json["pairs"].push_back({{"from", summary.name(pair.first)},
                             {"to", summary.name(pair.second)},
                             {"outcomes", sum(counts)},
                             {"bytes_sent", bytes_of(summary, pair).sent},
                             {"bytes_good", bytes_of(summary, pair).good},
                             {"by_outcome", to_json(counts)}});
  }
  json["windows"] = nlohmann::ordered_json::array();
  for (const auto& [start, counts] : summary.by_window()) {
    json["windows"].push_back(
        {{"from_s", in_seconds(start)}, {"outcomes", sum(counts)}, {"by_outcome", to_json(counts)}});
  }
  if (const EnergyCosts costs = energy_costs(summary.outcomes()); !costs.empty())
    json["energy"] = to_json(costs, summary);
  return json.dump(2);
}

void print_csv(std::ostream& out, const OutcomeSummary& summary) {
  out << "from,to,outcome,packets\n";
  for (const auto& [pair, counts] : summary.by_pair()) {
    for (std::size_t outcome = 0; outcome < counts.size(); ++outcome) {
      if (counts[outcome] == 0) continue;
      fmt::print(out, "{},{},{},{}\n", summary.name(pair.first), summary.name(pair.second),
                 outcome_name(outcome), counts[outcome]);
    }
  }
}

void print_outcomes_csv(std::ostream& out, const OutcomeSummary& summary) {
  out << "departure_s,decided_s,from,to,addressed_to,packet_sequence,outcome,travel_time_s,range_m,"
         "received_level_db,cutoff_level_db,noise_level_db,snr_db,interference_level_db,sinr_db,doppler_"
         "factor,"
         "num_paths,delay_spread_s,acquisition_probability,acquisition_draw,success_probability,success_draw,"
         "propagation,colliders,receivers,payload_bytes,transmit_energy_j,receive_energy_j,"
         "packet_kind,rate_number,duration_s,num_frames,num_frames_good,bytes_good,"
         "noise_db,late_echo_db,fast_fading_db,interference_db,impulse_db,loss_reason\n";
  for (const packet_outcome_t& o : summary.outcomes()) {
    fmt::print(out, "{:.3f},{:.3f},{},{},{},{},{}", in_seconds(o.departure_utime), in_seconds(o.utime),
               summary.name(o.source_id), summary.name(o.receiver_id),
               o.destination_id == 0 ? "all" : summary.name(o.destination_id), o.packet_sequence,
               outcome_name(static_cast<std::size_t>(o.outcome)));
    for (const double number :
         {o.travel_time_s, o.range_m, o.received_level_db, o.cutoff_level_db, o.noise_level_db, o.snr_db,
          o.interference_level_db, o.sinr_db, o.strongest_path_doppler_factor,
          static_cast<double>(o.num_paths), o.delay_spread_s, o.acquisition_probability, o.acquisition_draw,
          o.success_probability, o.success_draw}) {
      out << ',' << format_number(number);
    }
    out << ',' << propagation_name(static_cast<std::size_t>(o.propagation_used)) << ','
        << colliders_text(o, [&](std::int32_t id) { return summary.name(id); }) << ',' << o.num_receivers
        << ',' << o.payload_bytes << ',' << format_number(o.transmit_energy_j) << ','
        << format_number(o.receive_energy_j) << ',' << packet_kind_name(o.packet_kind) << ',' << o.rate_number
        << ',' << format_number(o.duration_s) << ',' << o.num_frames << ',' << o.num_frames_good << ','
        << o.bytes_good;
    for (const double power : {o.noise_db, o.late_echo_db, o.fast_fading_db, o.interference_db, o.impulse_db})
      out << ',' << format_number(power);
    out << ',' << loss_reason_name(static_cast<std::size_t>(o.loss_reason)) << '\n';
  }
}

Plot outcome_plot(const OutcomeSummary& summary, const std::string& title) {
  Chart totals{.x = "outcome", .y = "packets"};
  Chart over_time{.x = "departure, s", .y = "packets in a window"};
  Series bars{.title = "", .style = Series::kBars};
  for (const std::size_t outcome : outcomes_in(summary)) {
    bars.x.push_back(static_cast<double>(totals.categories.size()));
    bars.y.push_back(static_cast<double>(summary.total()[outcome]));
    totals.categories.emplace_back(outcome_name(outcome));
    Series line{.title = outcome_name(outcome), .style = Series::kLines};
    for (const auto& [start, counts] : summary.by_window()) {
      line.x.push_back(in_seconds(start));
      line.y.push_back(static_cast<double>(counts[outcome]));
    }
    over_time.series.push_back(std::move(line));
  }
  totals.series.push_back(std::move(bars));
  return {.title = title, .charts = {std::move(totals), std::move(over_time)}};
}

}  // namespace halocline::clients
