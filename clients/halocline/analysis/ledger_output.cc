// The ledger for people and programs.
#include <iomanip>
#include <numeric>
#include <ostream>
#include <sstream>

#include <nlohmann/json.hpp>

#include "clients/halocline/analysis/ledger.h"
#include "core/csv_table.h"

namespace halocline::clients {
namespace {

std::int64_t sum(const FateCounts& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
}

std::vector<std::size_t> causes_of(const Ledger& ledger) {
  std::vector<std::size_t> causes;
  for (std::size_t fate = 0; fate < ledger.total().size(); ++fate) {
    if (ledger.total()[fate] > 0) causes.push_back(fate);
  }
  return causes;
}

// One line of counts below a heading of causes.
void print_row(std::ostream& out, const std::string& title, const FateCounts& counts,
               const std::vector<std::size_t>& causes) {
  out << std::left << std::setw(26) << title << std::right << std::setw(9) << sum(counts);
  for (const std::size_t fate : causes) {
    const int width = std::max(9, static_cast<int>(std::string_view(fate_name(fate)).size()) + 2);
    out << std::setw(width) << counts[fate];
  }
  out << "\n";
}

void print_heading(std::ostream& out, const char* title, const std::vector<std::size_t>& causes) {
  out << "\n" << std::left << std::setw(26) << title << std::right << std::setw(9) << "all";
  for (const std::size_t fate : causes) {
    const std::string_view name = fate_name(fate);
    out << std::setw(std::max(9, static_cast<int>(name.size()) + 2)) << name;
  }
  out << "\n";
}

std::string in_seconds(std::int64_t utime) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(3) << static_cast<double>(utime) * 1e-6;
  return text.str();
}

nlohmann::ordered_json to_json(const FateCounts& counts) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (std::size_t fate = 0; fate < counts.size(); ++fate) {
    if (counts[fate] > 0) json[fate_name(fate)] = counts[fate];
  }
  return json;
}

std::string colliders_text(const Ledger& ledger, const packet_outcome_t& outcome) {
  std::string text;
  for (const packet_name_t& packet : outcome.colliders) {
    text += (text.empty() ? "" : " ") + ledger.name(packet.source_id) + ":" +
            std::to_string(packet.packet_sequence);
  }
  return text;
}

}  // namespace

void print(std::ostream& out, const Ledger& ledger) {
  const std::int64_t all = sum(ledger.total());
  out << all << " outcomes, one for each packet and possible receiver\n";
  for (const std::size_t fate : causes_of(ledger)) {
    const std::int64_t count = ledger.total()[fate];
    out << "  " << std::left << std::setw(24) << fate_name(fate) << std::right << std::setw(9) << count
        << std::fixed << std::setprecision(1) << std::setw(8)
        << 100.0 * static_cast<double>(count) / static_cast<double>(all) << " %\n";
  }
  if (ledger.repeated() > 0) out << ledger.repeated() << " repetitions were left out\n";
  if (all == 0) return;
  const auto causes = causes_of(ledger);
  print_heading(out, "from -> to", causes);
  for (const auto& [pair, counts] : ledger.by_pair())
    print_row(out, ledger.name(pair.first) + " -> " + ledger.name(pair.second), counts, causes);
  print_heading(out, "departure from, s", causes);
  for (const auto& [start, counts] : ledger.by_window()) print_row(out, in_seconds(start), counts, causes);
}

std::string to_json(const Ledger& ledger) {
  nlohmann::ordered_json json;
  json["outcomes"] = sum(ledger.total());
  json["repeated"] = ledger.repeated();
  json["causes"] = to_json(ledger.total());
  json["pairs"] = nlohmann::ordered_json::array();
  for (const auto& [pair, counts] : ledger.by_pair()) {
    json["pairs"].push_back({{"from", ledger.name(pair.first)},
                             {"to", ledger.name(pair.second)},
                             {"outcomes", sum(counts)},
                             {"causes", to_json(counts)}});
  }
  json["windows"] = nlohmann::ordered_json::array();
  for (const auto& [start, counts] : ledger.by_window()) {
    json["windows"].push_back({{"from_s", static_cast<double>(start) * 1e-6},
                               {"outcomes", sum(counts)},
                               {"causes", to_json(counts)}});
  }
  return json.dump(2);
}

void print_csv(std::ostream& out, const Ledger& ledger) {
  out << "from,to,cause,packets\n";
  for (const auto& [pair, counts] : ledger.by_pair()) {
    for (std::size_t fate = 0; fate < counts.size(); ++fate) {
      if (counts[fate] == 0) continue;
      out << ledger.name(pair.first) << ',' << ledger.name(pair.second) << ',' << fate_name(fate) << ','
          << counts[fate] << '\n';
    }
  }
}

void print_outcomes_csv(std::ostream& out, const Ledger& ledger) {
  out << "departure_s,decided_s,from,to,addressed_to,packet_sequence,cause,travel_time_s,range_m,"
         "received_level_db,cutoff_level_db,noise_level_db,snr_db,interference_level_db,sinr_db,doppler_"
         "factor,"
         "num_paths,delay_spread_s,acquisition_probability,acquisition_draw,success_probability,success_draw,"
         "colliders\n";
  for (const packet_outcome_t& o : ledger.outcomes()) {
    out << in_seconds(o.departure_utime) << ',' << in_seconds(o.utime) << ',' << ledger.name(o.source_id)
        << ',' << ledger.name(o.receiver_id) << ','
        << (o.destination_id == 0 ? "all" : ledger.name(o.destination_id)) << ',' << o.packet_sequence << ','
        << fate_name(static_cast<std::size_t>(o.outcome));
    for (const double number :
         {o.travel_time_s, o.range_m, o.received_level_db, o.cutoff_level_db, o.noise_level_db, o.snr_db,
          o.interference_level_db, o.sinr_db, o.strongest_path_doppler_factor,
          static_cast<double>(o.num_paths), o.delay_spread_s, o.acquisition_probability, o.acquisition_draw,
          o.success_probability, o.success_draw}) {
      out << ',' << format_number(number);
    }
    out << ',' << colliders_text(ledger, o) << '\n';
  }
}

Plot ledger_plot(const Ledger& ledger, const std::string& title) {
  Chart causes{.x = "cause", .y = "outcomes"};
  Chart over_time{.x = "departure, s", .y = "outcomes in a window"};
  Series bars{.title = "", .style = Series::kBars};
  for (const std::size_t fate : causes_of(ledger)) {
    bars.x.push_back(static_cast<double>(causes.categories.size()));
    bars.y.push_back(static_cast<double>(ledger.total()[fate]));
    causes.categories.emplace_back(fate_name(fate));
    Series line{.title = fate_name(fate), .style = Series::kLines};
    for (const auto& [start, counts] : ledger.by_window()) {
      line.x.push_back(static_cast<double>(start) * 1e-6);
      line.y.push_back(static_cast<double>(counts[fate]));
    }
    over_time.series.push_back(std::move(line));
  }
  causes.series.push_back(std::move(bars));
  return {.title = title, .charts = {std::move(causes), std::move(over_time)}};
}

}  // namespace halocline::clients
