// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/arrivals/arrival_output.h"

#include <array>
#include <cmath>
#include <iomanip>
#include <ostream>
#include <utility>

#include <nlohmann/json.hpp>

#include "core/check.h"
#include "core/csv_table.h"
#include "core/elementary.h"
#include "core/units.h"

namespace halocline::clients {
namespace {

using Column = std::pair<const char*, double>;

std::array<Column, 4> link_columns(const acoustics::RayLink& link, std::size_t index) {
  return {Column{"src_depth_m", link.source_depth_m}, Column{"rcv_depth_m", link.receiver_depth_m},
          Column{"rcv_range_m", link.range_m}, Column{"index", static_cast<double>(index)}};
}

std::array<Column, 13> path_columns(const acoustics::Eigenray& path) {
  return {Column{"delay_s", path.delay_s},
          Column{"amplitude", path.amplitude},
          Column{"phase_deg", to_degrees(path.phase_rad)},
          Column{"launch_angle_deg", to_degrees(path.launch_angle_rad)},
          Column{"arrival_angle_deg", to_degrees(path.arrival_angle_rad)},
          Column{"n_surface", path.surface_bounces},
          Column{"n_bottom", path.bottom_bounces},
          Column{"n_caustic", path.caustics},
          Column{"path_length_m", path.path_length_m},
          Column{"absorption_db", path.absorption_db},
          Column{"surface_loss_db", path.surface_loss_db},
          Column{"bottom_loss_db", path.bottom_loss_db},
          Column{"diffuse", path.diffuse ? 1 : 0}};
}

template <class Columns, class Text>
void append(std::string& line, const Columns& columns, const Text& text) {
  for (const Column& column : columns) line += (line.empty() ? "" : ",") + text(column);
}

std::array<Column, 2> received_columns(const acoustics::Arrival& path) {
  return {Column{"level_db", path.level.value}, Column{"doppler_factor", path.doppler_factor}};
}

void print_csv(std::ostream& out, const std::vector<LinkArrivals>& links) {
  const auto name = [](const Column& column) { return std::string(column.first); };
  const auto number = [](const Column& column) { return format_number(column.second); };
  std::string header;
  append(header, link_columns({}, 0), name);
  append(header, path_columns({}), name);
  if (!links.empty() && links.front().modems_known) append(header, received_columns({}), name);
  out << header << '\n';
  for (const LinkArrivals& found : links) {
    for (std::size_t i = 0; i < found.eigenrays.paths.size(); ++i) {
      std::string line;
      append(line, link_columns(found.link, i), number);
      append(line, path_columns(found.eigenrays.paths[i]), number);
      if (found.modems_known) append(line, received_columns(found.received.at(i)), number);
      out << line << '\n';
    }
  }
}

std::string finder_of(const LinkArrivals& found) {
  return found.found_by.empty() ? std::string(to_name(found.eigenrays.solver)) : found.found_by;
}

std::string cause_of_silence(const LinkArrivals& found) {
  return found.blocked ? "blocked" : std::string(to_name(found.eigenrays.lack));
}

nlohmann::ordered_json to_json(const LinkArrivals& found) {
  nlohmann::ordered_json json{{"src_depth_m", found.link.source_depth_m},
                              {"rcv_depth_m", found.link.receiver_depth_m},
                              {"rcv_range_m", found.link.range_m},
                              {"solver", finder_of(found)},
                              {"shadow", found.eigenrays.shadow() && !found.blocked}};
  if (found.eigenrays.silent()) {
    json["blocked"] = found.blocked;
    json["cause"] = cause_of_silence(found);
  } else {
    const acoustics::ReceivedField field = acoustics::received_field(found.eigenrays, {found.beams, {}});
    json["transmission_loss_db"] = -field.level.value;
    if (found.eigenrays.diffuse_power() > 0)
      json["diffuse_loss_db"] = -to_decibels(PowerRatio{found.eigenrays.diffuse_power()}).value;
    json["first_delay_s"] = field.first_delay_s;
    json["mean_delay_s"] = field.mean_delay_s;
    if (found.spreads) json["delay_spread_s"] = found.spreads->first_to_last_s;
    json["rms_delay_spread_s"] = found.spreads ? found.spreads->rms_s : field.delay_spread_s;
  }
  json["paths"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < found.eigenrays.paths.size(); ++i) {
    nlohmann::ordered_json row;
    for (const auto& [name, value] : path_columns(found.eigenrays.paths[i])) row[name] = value;
    if (found.modems_known) {
      for (const auto& [name, value] : received_columns(found.received.at(i))) row[name] = value;
    }
    json["paths"].push_back(row);
  }
  return json;
}

void print_row(std::ostream& out, const acoustics::Eigenray& path) {
  out << std::setprecision(6) << std::setw(12) << path.delay_s << std::setprecision(2) << std::setw(11)
      << 20 * elementary::log10(path.amplitude) << std::setw(13) << path.absorption_db << std::setprecision(3)
      << std::setw(12) << to_degrees(path.launch_angle_rad) << std::setw(13)
      << to_degrees(path.arrival_angle_rad) << std::setprecision(1) << std::setw(11)
      << to_degrees(path.phase_rad) << std::setw(9) << path.surface_bounces << std::setw(8)
      << path.bottom_bounces;
  if (path.diffuse) {
    out << std::setw(10) << "diffuse";
  } else {
    out << std::setw(10) << path.caustics;
  }
}

void print_received(std::ostream& out, const acoustics::Arrival& path) {
  out << std::setprecision(2) << std::setw(13) << path.level.value << std::setw(13)
      << 1e6 * (path.doppler_factor - 1);
}

void print_table(std::ostream& out, const LinkArrivals& found) {
  out << std::fixed << std::setprecision(2) << "from " << found.link.source_depth_m << " m to "
      << found.link.receiver_depth_m << " m deep, " << found.link.range_m
      << " m away: " << found.eigenrays.paths.size() << " paths, by " << finder_of(found) << '\n';
  if (found.eigenrays.silent()) {
    out << why_silent(found) << '\n';
    return;
  }
  out << "     delay s   level dB  absorbed dB  launch deg  arrival deg  phase deg  surface  bottom  caustics"
      << (found.modems_known ? "  received dB  Doppler ppm\n" : "\n");
  for (std::size_t i = 0; i < found.eigenrays.paths.size(); ++i) {
    print_row(out, found.eigenrays.paths[i]);
    if (found.modems_known) print_received(out, found.received.at(i));
    out << '\n';
  }
  const acoustics::ReceivedField field = acoustics::received_field(found.eigenrays, {found.beams, {}});
  out << std::setprecision(2) << "transmission loss " << -field.level.value << " dB (incoherent)"
      << std::setprecision(6);
  if (found.eigenrays.diffuse_power() > 0) {
    out << std::setprecision(2) << ", of it diffuse "
        << -to_decibels(PowerRatio{found.eigenrays.diffuse_power()}).value << " dB" << std::setprecision(6);
  }
  if (found.spreads) out << ", delay spread " << found.spreads->first_to_last_s << " s";
  out << ", rms delay spread " << (found.spreads ? found.spreads->rms_s : field.delay_spread_s) << " s\n";
}

}  // namespace

double path_level_db(const LinkArrivals& found, std::size_t index) {
  if (found.modems_known) return found.received.at(index).level.value;
  return 20 * elementary::log10(found.eigenrays.paths.at(index).received_pressure());
}

std::string why_silent(const LinkArrivals& found) {
  if (found.blocked) return "blocked: the bottom stands in every way";
  switch (found.eigenrays.lack) {
    case acoustics::PathLack::kTooWeak:
      return "too weak: the bounces leave too little of every ray";
    case acoustics::PathLack::kTooSteep:
      return "too steep: every ray is launched more steeply than the limit";
    case acoustics::PathLack::kShadow:
      break;
  }
  return "shadow: no ray gets there";
}

void print_impulse_response(std::ostream& out, const LinkArrivals& found, double carrier_hz, double rate_hz) {
  const acoustics::Eigenrays& eigenrays = found.eigenrays;
  out << "delay_s,real,imaginary,magnitude_db\n";
  if (eigenrays.silent()) return;
  require_in_range(rate_hz, 1, 1e7, "the rate of the impulse response", "Hz");
  const double first = std::round(eigenrays.paths.front().delay_s * rate_hz) - 1;
  const double count = std::round(eigenrays.paths.back().delay_s * rate_hz) + 2 - first;
  require(count <= 1e7, "an impulse response has at most 1e7 samples: choose a lower rate");
  const auto taps = acoustics::impulse_response(eigenrays, carrier_hz, rate_hz, first / rate_hz,
                                                static_cast<std::size_t>(count), found.beams);
  for (std::size_t i = 0; i < taps.size(); ++i) {
    out << format_number((first + static_cast<double>(i)) / rate_hz) << ',' << format_number(taps[i].real())
        << ',' << format_number(taps[i].imag()) << ',';
    // The level of a zero sample is left empty.
    if (std::abs(taps[i]) > 0) out << format_number(20 * elementary::log10(std::abs(taps[i])));
    out << '\n';
  }
}

void print_arrivals(std::ostream& out, const std::vector<LinkArrivals>& links, OutputFormat format) {
  if (format == OutputFormat::kCsv) return print_csv(out, links);
  if (format == OutputFormat::kTable) {
    for (const LinkArrivals& found : links) print_table(out, found);
    return;
  }
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const LinkArrivals& found : links) json.push_back(to_json(found));
  out << json.dump(2) << '\n';
}

}  // namespace halocline::clients
