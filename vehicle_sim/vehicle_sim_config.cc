// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/vehicle_sim_config.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <string_view>

#include "bus/config/carried_files.h"
#include "core/check.h"
#include "core/csv_table.h"
#include "core/files/file_path.h"
#include "ocean/ocean_field.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/model_config.h"
#include "vehicle_sim/model_library.h"
#include "vehicle_sim/moving_ocean.h"

namespace halocline::vehicle_sim {
namespace {

using bus::ConfigVisitor;
using bus::NumberRule;

const std::string kFixed = "fixed", kExternal = "external";
const double kFastestCurrent = 10;  // m/s

// Visits a period of the struct, which is a rate in the file.
void visit_rate(ConfigVisitor& v, std::string_view key, SimDuration& period, const NumberRule& rule) {
  double rate_hz = 1 / period.seconds();
  v.number(key, rate_hz, rule);
  period = SimDuration::from_seconds(1 / rate_hz);
}

void visit_depth_rows(ConfigVisitor& v, std::vector<DepthCurrent>& rows) {
  std::vector<Vec3> points;
  for (const DepthCurrent& row : rows) points.emplace_back(row.depth_m, row.north_mps, row.east_mps);
  v.points("depth_rows", points,
           {-1e5, 1e5, "",
            "rows of [depth m, north m/s, east m/s], depth rising; linear between, constant beyond"});
  rows.clear();
  for (const Vec3& p : points) {
    const bool rises = rows.empty() || rows.back().depth_m < p.x();
    const bool slow = std::max(std::abs(p.y()), std::abs(p.z())) <= kFastestCurrent;
    if (!rises || !slow || p.x() < 0)
      return v.problem("depth_rows", "allowed are depths from 0 that rise, and speeds of -10 to 10 m/s");
    rows.push_back({p.x(), p.y(), p.z()});
  }
}

void visit_current(ConfigVisitor& v, CurrentSettings& c) {
  visit_depth_rows(v, c.by_depth);
  v.number("tide_amplitude_mps", c.tide.amplitude_mps,
           {0, kFastestCurrent, "m/s", "amplitude of a tide to and fro; 0: none"});
  v.when(c.tide.amplitude_mps > 0, "tide_amplitude_mps above 0", [&] {
    v.number("tide_period_s", c.tide.period_s, {1, 1e9, "s", "period of the tide; 44714 s: the lunar tide"});
    bus::degrees(v, "tide_phase_deg", c.tide.phase_rad, {-360, 360, "deg", "phase at time 0; 0: full speed"});
    bus::degrees(v, "tide_toward_deg", c.tide.toward_rad,
                 {-360, 360, "deg", "direction towards which the tide flows, clockwise from north"});
  });
  v.number("random_deviation_mps", c.random.deviation_mps,
           {0, kFastestCurrent, "m/s",
            "standard deviation of a Gauss-Markov current, north and east each; 0: none"});
  v.when(c.random.deviation_mps > 0, "random_deviation_mps above 0", [&] {
    v.number("random_time_s", c.random.time_s, {0.1, 1e6, "s", "correlation time of that current"});
  });
}

void visit_waves(ConfigVisitor& v, WaveSettings& w) {
  const std::vector<std::string> kSeas{"calm", "regular", "pierson-moskowitz", "jonswap"};
  const auto with_sea = [&](std::initializer_list<SeaKind> seas, const std::function<void()>& body) {
    bus::when_one_of(v, "sea", w.kind, kSeas, seas, body);
  };
  bus::choice(v, "sea", w.kind, kSeas, "kind of sea");
  with_sea({SeaKind::kRegular, SeaKind::kPiersonMoskowitz, SeaKind::kJonswap}, [&] {
    v.number("height_m", w.height_m, {0, 40, "m", "height of regular waves, significant height of a sea"});
    v.number("period_s", w.period_s, {1, 30, "s", "period of regular waves, peak period of a sea"});
    bus::degrees(v, "toward_deg", w.toward_rad,
                 {-360, 360, "deg", "direction towards which the waves run, clockwise from north"});
  });
  with_sea({SeaKind::kJonswap}, [&] {
    v.number("peakedness", w.peakedness, {1, 10, "", "peak enhancement factor of jonswap"});
  });
}

// Returns the longest interval between two STATE messages at which no receiver loses a vehicle. The keys
// belong to the receivers; here they are only read. The age of the latest state grows to that interval plus
// the time that a message takes.
SimDuration longest_gap(ConfigVisitor& v) {
  SimDuration lag = SimDuration::from_milliseconds(50);
  SimDuration channel = SimDuration::from_milliseconds(5000), pilot = SimDuration::from_milliseconds(1000);
  v.section("channel_server", "", [&](ConfigVisitor& section) {
    section.shared_with_others();
    bus::seconds(section, "state_lag_s", lag, {0, 10, "s", ""});
    bus::seconds(section, "state_timeout_s", channel, {0.01, 3600, "s", ""});
  });
  v.section("autopilot", "", [&](ConfigVisitor& section) {
    section.shared_with_others();
    bus::seconds(section, "state_timeout_s", pilot, {0.01, 3600, "s", ""});
  });
  return std::min(channel, pilot) - lag;
}

void visit_state_rule(ConfigVisitor& v, StateRule& rule, SimDuration allowed) {
  v.number("state_deviation_m", rule.deviation_m,
           {0, 1000, "m",
            "error of the last STATE, extrapolated, above which a tick has a new one; 0: each tick has one"});
  v.when(rule.deviation_m > 0, "state_deviation_m above 0", [&] {
    bus::degrees(v, "state_deviation_deg", rule.deviation_rad,
                 {0.01, 180, "deg",
                  "error of the attitude above which a tick has a STATE, with state_deviation_m above 0"});
    bus::seconds(v, "state_longest_silence_s", rule.longest_silence,
                 {0.01, 2, "s", "longest time between two STATEs, with state_deviation_m above 0"});
  });
  if (v.writing() || rule.deviation_m == 0 || rule.longest_silence <= allowed) return;
  v.problem("state_longest_silence_s",
            "allowed is at most " + format_number(allowed.seconds()) +
                " s, or receivers lose the vehicle: the less of channel_server.state_timeout_s and "
                "autopilot.state_timeout_s, less channel_server.state_lag_s");
}

void visit_block(ConfigVisitor& v, VehicleBlock& block) {
  bus::integer_as(
      v, "blocks", block.count,
      {1, kMaxBlocks, "",
       "vehicle simulators that share the vehicles, in the order of the scenario; hulls of different "
       "blocks pass through each other"});
  bus::integer_as(v, "block", block.index,
                  {0, kMaxBlocks - 1.0, "", "number of this vehicle simulator; in one process all run"});
  if (!v.writing() && block.index >= block.count) v.problem("block", "allowed is 0 to blocks - 1");
}

void visit_tuning(ConfigVisitor& v, VehicleSimConfig& c, SimDuration allowed_silence) {
  bus::seconds(v, "step_s", c.step, {0.001, VehicleWorld::kLongestStep_s, "s", "step of the physics"});
  visit_state_rule(v, c.states, allowed_silence);
  bus::seconds(v, "command_timeout_s", c.command_timeout,
               {0.05, 3600, "s", "age at which a command is void: propeller stops, fins amidships"});
  v.number("buoyancy_over_weight", c.buoyancy_over_weight,
           {0.5, 2, "", "buoyancy over weight of every vehicle; above 1 they rise"});
  visit_block(v, c.block);
}

void visit_section(ConfigVisitor& v, VehicleSimConfig& c, SimDuration allowed_silence) {
  visit_rate(v, "state_rate_hz", c.state_period,
             {0.1, 100, "Hz", "STATE messages of each vehicle a second: its ticks"});
  visit_rate(v, "sensor_rate_hz", c.sensor_period,
             {0.1, 50, "Hz", "SENSORS messages of each vehicle a second"});
  v.number("altimeter_range_m", c.altimeter_range_m, {0.1, 10'000, "m", "maximum range of altimeters"});
  v.vector3("current_ned_mps", c.current.uniform_ned_mps,
            {-kFastestCurrent, kFastestCurrent, "m/s", "steady current everywhere: north, east, down"});
  bus::integer_as(v, "threads", c.threads, {1, 64, "", "threads that move vehicles; results are the same"});
  v.advanced([&] { visit_tuning(v, c, allowed_silence); });
  v.section("current", "Parts of the current that are added to current_ned_mps",
            [&](ConfigVisitor& section) { visit_current(section, c.current); });
  v.section("waves", "Waves: the motion of the water and, for models that float on them, of the surface",
            [&](ConfigVisitor& section) { visit_waves(section, c.waves); });
}

void visit_tethers(ConfigVisitor& v, std::vector<TetherEntry>& tethers) {
  const NumberRule place{-1e6, 1e6, "m",
                         "attachment on the vehicle: forward, starboard, down of the hull's middle"};
  const NumberRule other{-1e6, 1e6, "m",
                         "attachment on to_vehicle, likewise; of a fixed point: north, east, down"};
  v.list(
      "tether", "Rope between two vehicles, or a vehicle and a fixed point", tethers.size(),
      [&](std::size_t n) { tethers.resize(n); },
      [&](ConfigVisitor& item, std::size_t i) {
        TetherEntry& t = tethers[i];
        item.text("vehicle", t.vehicle, {}, "name of a vehicle that moves");
        item.vector3("attached_at_m", t.attached_at_m, place);
        item.text("to_vehicle", t.to_vehicle, {}, "name of another vehicle; empty: a fixed point");
        item.vector3("to_attached_at_m", t.to_attached_at_m, other);
        item.number("length_m", t.length_m, {0.01, 1e5, "m", "greatest distance of its ends; it only pulls"});
      });
}

void visit_common_sensors(ConfigVisitor& v, SensorSettings& sensors) {
  v.section("sensors", "Sensors of every vehicle that does not set its own",
            [&](ConfigVisitor& section) { visit(section, sensors); });
}

// Returns the sensors in the file of the vehicle's model; empty when it has none.
std::optional<SensorSettings> sensors_of_model(ConfigVisitor& v) {
  if (v.writing()) return std::nullopt;
  FilePath model = built_in_models().front();
  v.file("model", model, bus::FileNames::kShipped, "what moves it");
  if (!names_a_model_file(model)) return std::nullopt;
  std::optional<SensorSettings> sensors;
  bus::report_refusal(v, "model", [&] { sensors = load_model(model).sensors; });
  return sensors;
}

// Precedence of a key that is set more than once: [[vehicle]] overrides the scenario's [sensors], which
// override the model's file.
void visit_vehicle_sensors(ConfigVisitor& root, ConfigVisitor& v, VehicleSensors& vehicle,
                           const SensorSettings& common) {
  v.shared_with_others();
  v.text("name", vehicle.vehicle, {}, "channel suffix");
  if (!v.writing()) {
    const auto fitted = sensors_of_model(v);
    vehicle.own = fitted.has_value() || v.given("sensors");
    vehicle.sensors = fitted.value_or(common);
    if (fitted) visit_common_sensors(root, vehicle.sensors);
  }
  if (!vehicle.own) return;
  v.section(
      "sensors", "Sensors of this vehicle that differ, with the keys of [sensors]",
      [&](ConfigVisitor& section) { section.listed_elsewhere([&] { visit(section, vehicle.sensors); }); });
  // A key of [sensors] is used, too, when only this vehicle has the sensor that it belongs to.
  SensorSettings with_common = vehicle.sensors;
  if (!v.writing()) visit_common_sensors(root, with_common);
}

void visit_sensors(ConfigVisitor& v, VehicleSimConfig& config) {
  visit_common_sensors(v, config.sensors);
  v.list(
      "vehicle", "A vehicle", config.vehicles.size(), [&](std::size_t n) { config.vehicles.resize(n); },
      [&](ConfigVisitor& item, std::size_t i) {
        visit_vehicle_sensors(v, item, config.vehicles[i], config.sensors);
      });
}

// Returns the index of the member of that name; throws InvalidArgument when there is none. `what` begins the
// message.
std::size_t member_named(const std::vector<FleetMember>& members, const std::string& name,
                         const std::string& what = "tether") {
  const auto found =
      std::find_if(members.begin(), members.end(), [&](const FleetMember& m) { return m.name == name; });
  require(found != members.end(), what + ": \"" + name + "\" is no vehicle that the vehicle simulator moves");
  return static_cast<std::size_t>(found - members.begin());
}

FleetTether tether_of(const TetherEntry& entry, const std::vector<FleetMember>& members,
                      const VehicleBlock& block) {
  FleetTether t{.member = member_named(members, entry.vehicle),
                .attached_at_m = entry.attached_at_m,
                .to_member = {},
                .to_attached_at_m = entry.to_attached_at_m,
                .length_m = entry.length_m};
  if (!entry.to_vehicle.empty()) t.to_member = member_named(members, entry.to_vehicle);
  require(t.to_member != t.member, "tether: it must not lead from a vehicle to itself");
  require(members[t.member].model != nullptr, "tether: its vehicle must be one that moves");
  const auto block_of = [&](std::size_t member) { return block.of(member, members.size()); };
  require(!t.to_member || block_of(t.member) == block_of(*t.to_member),
          "tether: " + entry.vehicle + " and " + entry.to_vehicle + " are in different blocks of " +
              std::to_string(block.count) +
              "; allowed is one block: fewer vehicle_sim.blocks, or another order");
  return t;
}

// Checks the models of the vehicles. The key belongs to the scenario, which also writes it; here it is only
// read.
void check_models(ConfigVisitor& v) {
  std::vector<FilePath> models;
  std::string known = kFixed + ", " + kExternal;
  for (const std::string& name : built_in_models()) known = name + ", " + known;
  v.list(
      "vehicle", "", 0, [&](std::size_t n) { models.resize(n, built_in_models().front()); },
      [&](ConfigVisitor& item, std::size_t i) {
        item.shared_with_others();
        item.file("model", models[i], bus::FileNames::kShipped, "what moves it");
        const bool is_ours = models[i] == kFixed || models[i] == kExternal || names_a_model_file(models[i]);
        if (!is_ours && !is_built_in(models[i].place()))
          item.problem("model", "allowed are " + known + ", or a model file ending in .toml");
      });
}

VehicleState start_of(const bus::VehicleEntry& entry, const Vec3& start_ned_m, const Vec3& current_ned) {
  VehicleState start;
  start.position_ned_m = start_ned_m;
  start.orientation = to_quaternion({0, 0, entry.heading_rad});
  if (entry.model == kFixed) return start;
  start.velocity_body.head<3>() =
      start.orientation.conjugate() * current_ned + entry.speed_mps * Vec3::UnitX();
  return start;
}

std::shared_ptr<const Model> model_for(const FilePath& name, const VehicleSimConfig& config) {
  ModelParameters parameters = load_model(name).parameters;
  parameters.buoyancy_n *= config.buoyancy_over_weight;
  return std::make_shared<const Model>(parameters);
}

}  // namespace

void visit(ConfigVisitor& v, VehicleSimConfig& config) {
  const SimDuration allowed_silence = v.writing() ? SimDuration() : longest_gap(v);
  v.section("vehicle_sim", "Vehicle simulator",
            [&](ConfigVisitor& section) { visit_section(section, config, allowed_silence); });
  visit_sensors(v, config);
  visit_tethers(v, config.tethers);
  visit_faults(v, config.faults);
  check_models(v);
}

std::vector<FleetMember> members_of(const bus::Scenario& scenario, const VehicleSimConfig& config) {
  std::map<std::string, std::shared_ptr<const Model>> models;  // shared by vehicles of one model
  OceanCurrent current(config.current, scenario.seed);
  const auto ocean = moving_ocean(scenario);
  std::vector<FleetMember> members;
  for (const bus::VehicleEntry& entry : scenario.vehicles) {
    if (entry.model == kExternal) continue;
    const bool is_fixed = entry.model == kFixed;
    if (!is_fixed && !models.contains(entry.model.place()))
      models[entry.model.place()] = model_for(entry.model, config);
    const double depth = depth_below_surface_m(entry.start_ned_m, scenario.sea_surface_z_m);
    Vec3 current_there = current.everywhere(SimTime(), config.step).velocity_mps + current.at_depth(depth);
    if (ocean)
      current_there += ocean->current_ned_mps({entry.start_ned_m.x(), entry.start_ned_m.y(), depth}, 0);
    members.push_back({entry.name, is_fixed ? nullptr : models.at(entry.model.place()),
                       start_of(entry, scenario.start_ned_m(entry), current_there),
                       to_settings(entry.battery), entry.mount == bus::Mount::kFloating});
  }
  return members;
}

FleetSettings settings_of(const bus::Scenario& scenario, const VehicleSimConfig& config) {
  FleetSettings settings;
  settings.step = config.step;
  settings.command_timeout = config.command_timeout;
  settings.sea_surface_z_m = scenario.sea_surface_z_m;
  settings.tide = scenario.tide;
  settings.current = config.current;
  settings.ocean = moving_ocean(scenario);
  settings.waves = config.waves;
  settings.seed = scenario.seed;
  if (!config.tethers.empty()) {
    const std::vector<FleetMember> members = members_of(scenario, config);
    for (const TetherEntry& entry : config.tethers)
      settings.tethers.push_back(tether_of(entry, members, config.block));
  }
  return settings;
}

std::vector<SensorStation::Vehicle> stations_of(const bus::Scenario& scenario,
                                                const std::vector<FleetMember>& members,
                                                const VehicleSimConfig& config) {
  std::vector<SensorStation::Vehicle> stations;
  for (const FleetMember& member : members) {
    const auto own =
        std::find_if(config.vehicles.begin(), config.vehicles.end(),
                     [&](const VehicleSensors& entry) { return entry.own && entry.vehicle == member.name; });
    stations.push_back(
        {scenario.find(member.name)->id, own == config.vehicles.end() ? config.sensors : own->sensors});
  }
  return stations;
}

std::vector<std::pair<std::size_t, Fault>> faults_of(const std::vector<FleetMember>& members,
                                                     const VehicleSimConfig& config) {
  std::vector<std::pair<std::size_t, Fault>> faults;
  for (const FaultEntry& entry : config.faults) {
    const std::size_t member = member_named(members, entry.vehicle, "fault");
    require(
        entry.fault.kind != FaultKind::kEmptyBattery || members[member].battery,
        "fault: \"" + entry.vehicle + "\" has no battery that could be empty; give it a [vehicle.battery]");
    faults.emplace_back(member, entry.fault);
    if (entry.until <= entry.fault.from) continue;
    Fault end = entry.fault;
    end.from = entry.until;
    end.fixed = true;
    faults.emplace_back(member, end);
  }
  return faults;
}

}  // namespace halocline::vehicle_sim
