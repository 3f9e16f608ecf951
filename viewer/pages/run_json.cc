// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/pages/run_json.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>

#include <fmt/format.h>

#include "bus/version.h"
#include "runs/timeline/outcome_classes.h"
#include "viewer/pages/link_display.h"
#include "viewer/pages/plan_json.h"

namespace halocline::monitor {
namespace {

using nlohmann::json;

std::string upper(std::string text) {
  for (char& c : text)
    c = c == ' ' || c == '-' ? '_' : c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return text;
}

json outcomes_json() {
  json all = json::array();
  for (std::size_t code = 0; code < clients::kOutcomes; ++code) {
    const clients::OutcomeClass& shown = clients::outcome_classes()[clients::class_of_outcome(code)];
    const std::string name = clients::outcome_name(code);
    all.push_back({{"code", code},
                   {"name", upper(name)},
                   {"label", name},
                   {"class", shown.key},
                   {"mark", shown.mark},
                   {"colour", shown.colour}});
  }
  all.push_back({{"code", -1},
                 {"name", "PENDING"},
                 {"label", "not decided yet"},
                 {"class", "pending"},
                 {"mark", "ring"},
                 {"colour", "#999999"}});
  return all;
}

json columns_json() {
  json all = json::array();
  for (const LinkDisplay& display : link_displays()) {
    json categories = json::array();
    for (const LinkCategory& category : display.categories)
      categories.push_back({{"value", category.value}, {"label", category.label}, {"good", category.good}});
    all.push_back({{"key", display.key},
                   {"label", display.label},
                   {"unit", display.unit},
                   {"digits", display.digits},
                   {"scale", display.scale},
                   {"center", display.center},
                   {"low", display.low},
                   {"high", display.high},
                   {"better", display.better},
                   {"help", display.help},
                   {"categories", std::move(categories)}});
  }
  return all;
}

json number_or_null(const std::optional<double>& number) { return number ? json(*number) : json(); }

std::optional<double> threshold_db(const Source& source, const clients::VehicleRecord& vehicle) {
  return vehicle.modem ? source.threshold_db(*vehicle.modem) : std::nullopt;
}

template <class Numbers>
json modem_of(const std::string& family, const Numbers& modem) {
  return {{"family", family},
          {"source_level_db", modem.source_level_db},
          {"center_frequency_hz", modem.center_frequency_hz},
          {"bandwidth_hz", modem.bandwidth_hz},
          {"bit_rate_bps", modem.bit_rate_bps}};
}

json modem_json(const Source& source, const clients::VehicleRecord& vehicle) {
  json modem;
  if (vehicle.modem)
    modem = modem_of(vehicle.modem->family, *vehicle.modem);
  else if (vehicle.described)
    modem = modem_of(vehicle.described->modem_family, *vehicle.described);
  else
    return modem;
  modem["threshold_db"] = number_or_null(threshold_db(source, vehicle));
  return modem;
}

// Returns the threshold that most vehicles share; null when none is known.
json threshold_json(const Source& source) {
  std::map<double, int> vehicles;
  for (const clients::VehicleRecord& vehicle : source.timeline().vehicles()) {
    if (const auto threshold = threshold_db(source, vehicle)) ++vehicles[*threshold];
  }
  const auto most = std::max_element(vehicles.begin(), vehicles.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == vehicles.end() ? json() : json(most->first);
}

json vehicle_json(const Source& source, const clients::VehicleRecord& vehicle, SimTime at) {
  return {{"index", vehicle.index},
          {"name", vehicle.name},
          {"id", vehicle.id},
          {"model", vehicle.described ? vehicle.described->vehicle_model : ""},
          {"fixed", vehicle.is_at_rest()},
          {"colour", vehicle.index},
          {"modem", modem_json(source, vehicle)},
          {"plan", plan_json(vehicle, at)}};
}

json water_json(const clients::RunTimeline& timeline, SimTime at) {
  const auto* water = timeline.water().at_or_before(std::max(at, SimTime()));
  if (water == nullptr) return nullptr;
  constexpr std::size_t kMaxRows = 200;
  const std::size_t rows = water->value.layer_depth_m.size(), step = rows / kMaxRows + 1;
  json depth_m = json::array(), speed_mps = json::array();
  for (std::size_t i = 0; i < rows; i = i + step < rows || i + 1 == rows ? i + step : rows - 1) {
    depth_m.push_back(water->value.layer_depth_m[i]);
    speed_mps.push_back(water->value.layer_sound_speed_mps[i]);
  }
  return {{"depth_m", std::move(depth_m)},
          {"sound_speed_mps", std::move(speed_mps)},
          {"wind_mps", water->value.wind_speed_mps}};
}

json terrain_json(const clients::RunTimeline& timeline) {
  const auto grid = overview_grid(timeline);
  if (!grid) return nullptr;
  double least = NAN, greatest = NAN;
  for (const float depth_m : grid->depth_m) {
    if (std::isnan(depth_m)) continue;
    least = std::fmin(least, depth_m);
    greatest = std::fmax(greatest, depth_m);
  }
  // The revision is a hash of the depths: a page fetches the terrain again when it differs.
  std::size_t revision = 14695981039346656037U;
  for (const float depth_m : grid->depth_m)
    revision = (revision ^ std::hash<float>()(depth_m)) * 1099511628211U;
  return {{"south_m", grid->south_m}, {"west_m", grid->west_m},          {"spacing_m", grid->spacing_m},
          {"rows", grid->rows},       {"columns", grid->columns},        {"min_depth_m", least},
          {"max_depth_m", greatest},  {"revision", revision % 1'000'000}};
}

const char* bus_text(BusCondition condition) {
  switch (condition) {
    case BusCondition::kLive:
      return "live";
    case BusCondition::kSilent:
      return "silent";
    case BusCondition::kReconnecting:
      return "reconnecting";
    case BusCondition::kNone:
      break;
  }
  return "none";
}

json nodes_json(const Source& source, SimTime at) {
  json all = json::array();
  for (const auto& [name, node] : source.timeline().health().nodes()) {
    const node_status_t& status = node.status;
    all.push_back({{"name", name},
                   {"age_s", source.age_s(node, at)},
                   {"received", status.messages_received},
                   {"sent", status.messages_sent},
                   {"refused", status.messages_refused},
                   {"gaps", status.gaps},
                   {"repaired", status.repaired},
                   {"lost", status.lost},
                   {"duplicates", status.duplicates},
                   {"late", status.late},
                   {"lateness_max_s", status.lateness_max_s},
                   {"text", status.status_text}});
  }
  return all;
}

json vehicle_states_json(const clients::RunTimeline& timeline, SimTime at) {
  json all = json::array();
  for (const clients::VehicleRecord& vehicle : timeline.vehicles()) {
    json faults = json::array();
    for (const vehicle_fault_t& fault : faults_at(vehicle, at)) faults.push_back(fault_text(fault));
    const std::string activity = activity_at(vehicle, at);
    all.push_back({{"index", vehicle.index},
                   {"activity", activity.empty() ? json() : json(activity)},
                   {"faults", std::move(faults)}});
  }
  return all;
}

bool is_of_one_kind(const vehicle_fault_t& a, const vehicle_fault_t& b) {
  return a.fault_kind == b.fault_kind &&
         (a.fault_kind != vehicle_fault_t::DEAD_SENSOR || a.dead_sensor == b.dead_sensor);
}

}  // namespace

json hello_json(const Source& source, bool may_command) {
  const clients::RunTimeline& timeline = source.timeline();
  const bool is_empty = timeline.begin() > timeline.end();
  return {{"type", "hello"},
          {"version", 1},
          {"program", fmt::format("halocline-monitor {}", bus::kVersion)},
          {"source", source.is_log() ? "log" : "bus"},
          {"name", source.name()},
          {"begin_s", is_empty ? 0 : timeline.begin().seconds()},
          {"end_s", is_empty ? 0 : source.now().seconds()},
          {"may_command", may_command},
          {"limits", source.limits()},
          {"outcomes", outcomes_json()},
          {"link_columns", columns_json()}};
}

std::optional<DepthGrid> overview_grid(const clients::RunTimeline& timeline) {
  const auto& terrain = timeline.terrain();
  if (!terrain || terrain->rows == 0 || terrain->columns == 0) return std::nullopt;
  return DepthGrid{.south_m = terrain->south_m,
                   .west_m = terrain->west_m,
                   .spacing_m = terrain->north_spacing_m,
                   .rows = static_cast<std::uint16_t>(terrain->rows),
                   .columns = static_cast<std::uint16_t>(terrain->columns),
                   .depth_m = terrain->depth_m};
}

json run_json(const Source& source, SimTime at) {
  const clients::RunTimeline& timeline = source.timeline();
  const clients::RunScenario& scenario = timeline.scenario();
  json vehicles = json::array();
  for (const clients::VehicleRecord& vehicle : timeline.vehicles())
    vehicles.push_back(vehicle_json(source, vehicle, at));
  json origin;
  if (scenario.origin)
    origin = {{"latitude_deg", scenario.origin->latitude_deg},
              {"longitude_deg", scenario.origin->longitude_deg}};
  return {{"type", "run"},
          {"name", scenario.name},
          {"description", scenario.description},
          {"seed", scenario.seed},
          {"origin", std::move(origin)},
          {"sea_surface_down_m", scenario.sea_surface_z_m},
          {"vehicles", std::move(vehicles)},
          {"threshold_db", threshold_json(source)},
          {"terrain", terrain_json(timeline)},
          {"water", water_json(timeline, at)}};
}

json state_json(const Source& source, const Playback& playback) {
  const clients::RunTimeline& timeline = source.timeline();
  const SourceState state = source.state();
  const bool is_empty = timeline.begin() > timeline.end();
  const bool has_states =
      std::any_of(timeline.vehicles().begin(), timeline.vehicles().end(),
                  [](const clients::VehicleRecord& vehicle) { return !vehicle.track.empty(); });
  return {{"type", "state"},
          {"time_s", playback.at().seconds()},
          {"begin_s", is_empty ? 0 : timeline.begin().seconds()},
          {"end_s", is_empty ? 0 : source.now().seconds()},
          {"live", playback.is_live()},
          {"playing", playback.is_playing()},
          {"speed", playback.speed()},
          {"bus", bus_text(state.bus)},
          {"silent_s", state.silent_s},
          {"has_states", has_states},
          {"bathymetry", state.bathymetry},
          {"channel_server", state.channel_server},
          {"real_time_factor", state.real_time_factor ? json(*state.real_time_factor) : json()},
          {"messages_dropped", state.messages_dropped},
          {"vehicles", vehicle_states_json(timeline, playback.at())},
          {"nodes", nodes_json(source, playback.at())}};
}

bool is_same_condition(const json& state, const json& other) {
  for (const char* member :
       {"live", "playing", "speed", "bus", "has_states", "bathymetry", "channel_server", "vehicles"}) {
    if (state.value(member, json()) != other.value(member, json())) return false;
  }
  return true;
}

std::string fault_text(const vehicle_fault_t& fault) {
  constexpr const char* kSensors[] = {"depth sensor", "altimeter", "water speed log", "compass", "gyro",
                                      "DVL",          "GPS",       "sonar",           "USBL"};
  const std::string at_angle =
      fault.stuck_angle_given != 0
          ? fmt::format(" at {:.3g} degrees", fault.stuck_angle_rad * 180 / std::numbers::pi)
          : "";
  switch (fault.fault_kind) {
    case vehicle_fault_t::STUCK_RUDDER:
      return "rudder stuck" + at_angle;
    case vehicle_fault_t::STUCK_STERN_PLANES:
      return "stern planes stuck" + at_angle;
    case vehicle_fault_t::LOST_PROPELLER:
      return "propeller lost";
    case vehicle_fault_t::LEAK:
      return fmt::format("leak of {:.3g} kg/s", fault.leak_rate_kg_s);
    case vehicle_fault_t::DEAD_SENSOR:
      return std::string(kSensors[std::clamp<int>(fault.dead_sensor, 0, 8)]) + " dead";
    default:
      return "unknown fault";
  }
}

std::vector<vehicle_fault_t> faults_at(const clients::VehicleRecord& vehicle, SimTime at) {
  std::vector<vehicle_fault_t> active;
  for (const auto& [from, fault] : vehicle.faults) {
    if (from > at) continue;
    std::erase_if(active,
                  [&fault = fault](const vehicle_fault_t& other) { return is_of_one_kind(other, fault); });
    if (fault.fault_fixed == 0) active.push_back(fault);
  }
  return active;
}

}  // namespace halocline::monitor
