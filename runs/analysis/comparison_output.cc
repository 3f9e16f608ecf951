// SPDX-License-Identifier: BSD-3-Clause
// Output of a comparison as text, JSON and CSV.
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/ostream.h>
#include <nlohmann/json.hpp>

#include "core/csv_table.h"
#include "runs/analysis/comparison.h"
#include "runs/timeline/packet_reasons.h"

namespace halocline::clients {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kRowsShown = 20;

// Returns the numbers of an outcome by name: columns of the CSV table, members of the JSON objects.
std::vector<std::pair<const char*, double>> numbers_of(const packet_outcome_t& o) {
  return {{"departure_s", static_cast<double>(o.departure_utime) * 1e-6},
          {"decided_s", static_cast<double>(o.utime) * 1e-6},
          {"travel_time_s", o.travel_time_s},
          {"range_m", o.range_m},
          {"num_paths", static_cast<double>(o.num_paths)},
          {"received_level_db", o.received_level_db},
          {"cutoff_level_db", o.cutoff_level_db},
          {"noise_level_db", o.noise_level_db},
          {"snr_db", o.snr_db},
          {"interference_level_db", o.interference_level_db},
          {"sinr_db", o.sinr_db},
          {"doppler_factor", o.strongest_path_doppler_factor},
          {"acquisition_probability", o.acquisition_probability},
          {"acquisition_draw", o.acquisition_draw},
          {"success_probability", o.success_probability},
          {"success_draw", o.success_draw}};
}

std::string addressee(const Comparison& comparison, const packet_outcome_t& outcome) {
  return outcome.destination_id == 0 ? "all" : comparison.name(outcome.destination_id);
}

Json to_json(const std::optional<packet_outcome_t>& outcome, const Comparison& comparison) {
  if (!outcome) return nullptr;
  Json json;
  for (const auto& [name, value] : numbers_of(*outcome)) json[name] = value;
  json["colliders"] = colliders_text(*outcome, [&](std::int32_t id) { return comparison.name(id); });
  return json;
}

void print_row(std::ostream& out, const Comparison& comparison, const Comparison::Row& row) {
  const packet_outcome_t& packet = row.any();
  fmt::print(out, "  {:>11.3f} s  {}:{} at {}: {} -> {}{}{}\n",
             static_cast<double>(packet.departure_utime) * 1e-6, comparison.name(packet.source_id),
             packet.packet_sequence, comparison.name(packet.receiver_id), row.outcome_before,
             row.outcome_after, row.why.empty() ? "" : "; ", row.why);
}

}  // namespace

void print(std::ostream& out, const Comparison& comparison) {
  const auto all = comparison.rows().size();
  if (!comparison.anything_before()) {
    out << "The first log holds no outcomes: there is nothing to compare the " << all
        << " of the second with.\n";
    return;
  }
  fmt::print(
      out,
      "{} packets at receivers: {} changed their outcome, {} kept it, {} of them with the same numbers\n",
      all, comparison.changed(), static_cast<std::int64_t>(all) - comparison.changed(),
      comparison.identical());
  if (!comparison.transitions().empty()) out << "\nbefore -> after\n";
  for (const auto& [change, count] : comparison.transitions())
    fmt::print(out, "  {:<52}{:>9}\n", change.first + " -> " + change.second, count);
  if (!comparison.moved_inputs().empty()) out << "\nof the changed, these differ\n";
  for (const auto& [input, count] : comparison.moved_inputs())
    fmt::print(out, "  {:<52}{:>9}\n", input, count);
  if (comparison.changed() == 0) return;
  out << "\nchanged"
      << (comparison.changed() > static_cast<std::int64_t>(kRowsShown) ? " (the first 20)" : "") << "\n";
  std::size_t shown = 0;
  for (const Comparison::Row& row : comparison.rows()) {
    if (row.changed() && shown++ < kRowsShown) print_row(out, comparison, row);
  }
}

std::string to_json(const Comparison& comparison) {
  Json json;
  json["packets_at_receivers"] = comparison.rows().size();
  json["first_log_has_outcomes"] = comparison.anything_before();
  json["changed"] = comparison.changed();
  json["identical"] = comparison.identical();
  json["transitions"] = Json::array();
  for (const auto& [change, count] : comparison.transitions())
    json["transitions"].push_back({{"before", change.first}, {"after", change.second}, {"packets", count}});
  json["moved"] = comparison.moved_inputs();
  json["rows"] = Json::array();
  for (const Comparison::Row& row : comparison.rows()) {
    if (!row.changed()) continue;
    const packet_outcome_t& packet = row.any();
    json["rows"].push_back({{"from", comparison.name(packet.source_id)},
                            {"to", comparison.name(packet.receiver_id)},
                            {"addressed_to", addressee(comparison, packet)},
                            {"send_session", packet.send_session},
                            {"packet_sequence", packet.packet_sequence},
                            {"before", row.outcome_before},
                            {"after", row.outcome_after},
                            {"moved", row.moved},
                            {"why", row.why},
                            {"numbers_before", to_json(row.before, comparison)},
                            {"numbers_after", to_json(row.after, comparison)}});
  }
  return json.dump(2);
}

void print_csv(std::ostream& out, const Comparison& comparison) {
  const auto named = [&](std::int32_t id) { return comparison.name(id); };
  out << "from,to,addressed_to,send_session,packet_sequence,before,after,changed,moved,why";
  for (const char* side : {"before", "after"}) {
    for (const auto& [name, value] : numbers_of({})) out << "," << side << "_" << name;
    out << "," << side << "_colliders";
  }
  out << "\n";
  for (const Comparison::Row& row : comparison.rows()) {
    const packet_outcome_t& packet = row.any();
    out << comparison.name(packet.source_id) << ',' << comparison.name(packet.receiver_id) << ','
        << addressee(comparison, packet) << ',' << packet.send_session << ',' << packet.packet_sequence << ','
        << row.outcome_before << ',' << row.outcome_after << ',' << (row.changed() ? 1 : 0) << ','
        << fmt::format("{}", fmt::join(row.moved, " ")) << ",\"" << row.why << '"';
    for (const auto* side : {&row.before, &row.after}) {
      for (const auto& [name, value] : numbers_of(side->value_or(packet_outcome_t{})))
        out << ',' << (*side ? format_number(value) : "");
      out << ',' << (*side ? colliders_text(**side, named) : "");
    }
    out << "\n";
  }
}

}  // namespace halocline::clients
