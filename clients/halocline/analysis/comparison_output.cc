// The comparison for people and programs.
#include <algorithm>
#include <cstdio>
#include <iomanip>
#include <ostream>

#include <nlohmann/json.hpp>

#include "clients/halocline/analysis/comparison.h"
#include "core/csv_table.h"

namespace halocline::clients {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kRowsShown = 20;

std::string formatted(const char* format, double a, double b, double c) {
  char text[160];
  std::snprintf(text, sizeof text, format, a, b, c);
  return text;
}

std::string colliders_of(const packet_outcome_t& outcome,
                         const std::function<std::string(std::int32_t)>& name) {
  std::string text;
  for (const packet_name_t& packet : outcome.colliders)
    text += (text.empty() ? "" : " ") + name(packet.source_id) + ":" + std::to_string(packet.packet_sequence);
  return text;
}

// The numbers of an outcome, by name: columns of the table, members of the JSON.
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

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

std::string addressee(const Comparison& comparison, const packet_outcome_t& outcome) {
  return outcome.destination_id == 0 ? "all" : comparison.name(outcome.destination_id);
}

Json to_json(const std::optional<packet_outcome_t>& outcome, const Comparison& comparison) {
  if (!outcome) return nullptr;
  Json json;
  for (const auto& [name, value] : numbers_of(*outcome)) json[name] = value;
  json["colliders"] = colliders_of(*outcome, [&](std::int32_t id) { return comparison.name(id); });
  return json;
}

void print_row(std::ostream& out, const Comparison& comparison, const Comparison::Row& row) {
  const packet_outcome_t& packet = row.any();
  out << "  " << std::fixed << std::setprecision(3) << std::setw(11)
      << static_cast<double>(packet.departure_utime) * 1e-6 << " s  " << comparison.name(packet.source_id)
      << ":" << packet.packet_sequence << " at " << comparison.name(packet.receiver_id) << ": "
      << row.fate_before << " -> " << row.fate_after << (row.why.empty() ? "" : "; ") << row.why << "\n";
}

}  // namespace

std::string deciding_numbers(const packet_outcome_t& o,
                             const std::function<std::string(std::int32_t)>& name) {
  const std::string others = colliders_of(o, name);
  const std::string beside = others.empty() ? "" : " with " + others;
  switch (o.outcome) {
    case packet_outcome_t::RECEIVED:
      return formatted("success %.3g above draw %.3g at SINR %.1f dB", o.success_probability, o.success_draw,
                       o.sinr_db);
    case packet_outcome_t::BELOW_CUTOFF:
      return formatted("level %.1f dB below the cut-off %.1f dB", o.received_level_db, o.cutoff_level_db, 0);
    case packet_outcome_t::RECEIVER_GONE:
      return "the receiver's states had grown too old";
    case packet_outcome_t::SHADOW:
      return "no path: the water bends all away";
    case packet_outcome_t::BLOCKED:
      return "no path: the terrain stands in all";
    case packet_outcome_t::OUT_OF_BAND:
      return "the bands of the two modems share nothing";
    case packet_outcome_t::HALF_DUPLEX:
      return "the receiver itself sent " + others;
    case packet_outcome_t::DOPPLER:
      return formatted("Doppler factor %.6f is beyond what the modem follows",
                       o.strongest_path_doppler_factor, 0, 0);
    case packet_outcome_t::COLLIDED:
      if (o.success_probability == 0) return "the receiver followed " + others;
      [[fallthrough]];
    case packet_outcome_t::BIT_ERRORS:
      return formatted("success %.3g not above draw %.3g at SINR %.1f dB", o.success_probability,
                       o.success_draw, o.sinr_db) +
             beside;
    case packet_outcome_t::NOT_ACQUIRED:
      return formatted("acquisition %.3g not above draw %.3g at SNR %.1f dB", o.acquisition_probability,
                       o.acquisition_draw, o.snr_db) +
             beside;
  }
  return "";
}

void print(std::ostream& out, const Comparison& comparison) {
  const auto all = comparison.rows().size();
  if (!comparison.anything_before()) {
    out << "The first log holds no outcomes: there is nothing to compare the " << all
        << " of the second with.\n";
    return;
  }
  out << all << " packets at receivers: " << comparison.changed() << " changed their fate, "
      << static_cast<std::int64_t>(all) - comparison.changed() << " kept it, " << comparison.identical()
      << " of them with the same numbers\n";
  if (!comparison.transitions().empty()) out << "\nbefore -> after\n";
  for (const auto& [fates, count] : comparison.transitions())
    out << "  " << std::left << std::setw(52) << fates.first + " -> " + fates.second << std::right
        << std::setw(9) << count << "\n";
  if (!comparison.moved_inputs().empty()) out << "\nof the changed, these differ\n";
  for (const auto& [input, count] : comparison.moved_inputs())
    out << "  " << std::left << std::setw(52) << input << std::right << std::setw(9) << count << "\n";
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
  for (const auto& [fates, count] : comparison.transitions())
    json["transitions"].push_back({{"before", fates.first}, {"after", fates.second}, {"packets", count}});
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
                            {"before", row.fate_before},
                            {"after", row.fate_after},
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
        << row.fate_before << ',' << row.fate_after << ',' << (row.changed() ? 1 : 0) << ','
        << joined(row.moved) << ",\"" << row.why << '"';
    for (const auto* side : {&row.before, &row.after}) {
      for (const auto& [name, value] : numbers_of(side->value_or(packet_outcome_t{})))
        out << ',' << (*side ? format_number(value) : "");
      out << ',' << (*side ? colliders_of(**side, named) : "");
    }
    out << "\n";
  }
}

}  // namespace halocline::clients
