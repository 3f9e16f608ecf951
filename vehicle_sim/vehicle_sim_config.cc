#include "vehicle_sim/vehicle_sim_config.h"

#include "core/check.h"
#include "vehicle_sim/remus100_pvs.h"

namespace halocline::vehicle_sim {
namespace {

using bus::ConfigVisitor;
using bus::NumberRule;

const std::string kFixed = "fixed", kExternal = "external";
const std::vector<std::string> kModels{kRemus100PvsName, kFixed, kExternal};

// A rate in the file, a period in the struct.
void visit_rate(ConfigVisitor& v, std::string_view key, SimDuration& period, const NumberRule& rule) {
  double rate_hz = 1 / period.seconds();
  v.number(key, rate_hz, rule);
  period = SimDuration::from_seconds(1 / rate_hz);
}

void visit_section(ConfigVisitor& v, VehicleSimConfig& c) {
  bus::seconds(v, "step_s", c.step, {0.001, VehicleWorld::kLongestStep_s, "s", "step of the physics"});
  visit_rate(v, "state_rate_hz", c.state_period, {0.1, 100, "Hz", "STATE messages of each vehicle a second"});
  visit_rate(v, "sensor_rate_hz", c.sensor_period,
             {0.1, 50, "Hz", "SENSORS messages of each vehicle a second"});
  bus::seconds(v, "command_timeout_s", c.command_timeout,
               {0.05, 3600, "s", "age at which a command is void: propeller stops, fins amidships"});
  v.number("altimeter_range_m", c.altimeter_range_m, {0.1, 10'000, "m", "greatest altitude measured"});
  bus::seconds(v, "altimeter_patience_s", c.altimeter_patience,
               {0.01, 5, "s", "how long sensors wait for the bathymetry service"});
  v.vector3("current_ned_mps", c.current_ned_mps, {-5, 5, "m/s", "steady current: north, east, down"});
  bus::choice(v, "current_treatment", c.current_treatment, {"upstream", "galilean"},
              "how the current acts: as published with the model, or exactly");
  v.number("buoyancy_over_weight", c.buoyancy_over_weight,
           {0.5, 2, "", "of every vehicle; above 1 they rise"});
  v.number("seabed_friction", c.seabed_friction, {0, 10, "", "Coulomb's coefficient of hull on seabed"});
}

// The key itself belongs to the scenario, which also writes it; here it is only looked at.
void check_models(ConfigVisitor& v) {
  std::vector<std::string> models;
  v.list(
      "vehicle", "", 0, [&](std::size_t n) { models.resize(n, kRemus100PvsName); },
      [&](ConfigVisitor& item, std::size_t i) {
        item.shared_with_others();
        item.text("model", models[i], kModels, "what moves it");
      });
}

VehicleState start_of(const bus::VehicleEntry& entry, const Vec3& current_ned) {
  VehicleState start;
  start.position_ned_m = entry.start_ned_m;
  start.orientation = to_quaternion({0, 0, entry.heading_rad});
  if (entry.model == kFixed) return start;
  start.velocity_body.head<3>() =
      start.orientation.conjugate() * current_ned + entry.speed_mps * Vec3::UnitX();
  return start;
}

}  // namespace

void visit(ConfigVisitor& v, VehicleSimConfig& config) {
  v.section("vehicle_sim", "The vehicle simulator",
            [&](ConfigVisitor& section) { visit_section(section, config); });
  check_models(v);
}

std::vector<FleetMember> members_of(const bus::Scenario& scenario, const VehicleSimConfig& config) {
  ModelParameters parameters = remus100_pvs_parameters(config.current_treatment);
  parameters.buoyancy_n *= config.buoyancy_over_weight;
  const auto remus = std::make_shared<const Model>(parameters);
  std::vector<FleetMember> members;
  for (const bus::VehicleEntry& entry : scenario.vehicles) {
    if (entry.model == kExternal) continue;
    const bool is_fixed = entry.model == kFixed;
    require(is_fixed || entry.model == kRemus100PvsName,
            "vehicle " + entry.name + ": unknown model " + entry.model);
    members.push_back({entry.name, is_fixed ? nullptr : remus, start_of(entry, config.current_ned_mps)});
  }
  return members;
}

FleetSettings settings_of(const bus::Scenario& scenario, const VehicleSimConfig& config) {
  FleetSettings settings;
  settings.step = config.step;
  settings.command_timeout = config.command_timeout;
  settings.water = {config.current_ned_mps, scenario.sea_surface_z_m};
  settings.seabed_friction = config.seabed_friction;
  return settings;
}

}  // namespace halocline::vehicle_sim
