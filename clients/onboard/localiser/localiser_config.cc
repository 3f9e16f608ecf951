// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/localiser/localiser_config.h"

#include <algorithm>
#include <sstream>

#include "core/check.h"

namespace halocline::clients {
namespace {

using bus::ConfigVisitor;

void visit_ranging(ConfigVisitor& v, VehicleLocaliser& l) {
  double period_s = l.ping_period.seconds(), start_s = l.ping_start.seconds();
  v.text("beacons", l.beacons, {}, "names of vehicles that do not move, with spaces between; empty: none");
  v.number("ping_period_s", period_s, {0, 1e6, "s", "time between pings, to the beacons in turn; 0: none"});
  v.number("ping_start_s", start_s, {0, 1e7, "s", "time of the first ping, by the vehicle's clock"});
  l.ping_period = SimDuration::from_seconds(period_s);
  l.ping_start = SimTime::from_seconds(start_s);
  v.boolean("use_stamps", l.use_stamps, "true: ranges are also taken from stamped packets of the beacons");
  v.number("start_sigma_m", l.start_sigma_m,
           {0, 1e5, "m", "standard deviation of the known start; 0: the start is unknown"});
  v.number("clock_offset_sigma_s", l.rules.clock_offset_sigma_s,
           {0, 1e5, "s", "standard deviation of the clock's offset at the start; 0: the clock is right"});
}

void visit_clock_rules(ConfigVisitor& v, EstimatorRules& r) {
  double drift_ppm = r.clock_drift_sigma * 1e6;
  v.number("clock_drift_sigma_ppm", drift_ppm, {0, 1000, "ppm", "deviation of the clock's drift"});
  r.clock_drift_sigma = drift_ppm * 1e-6;
  v.number("clock_walk_s_per_sqrt_s", r.clock_walk_s_per_sqrt_s,
           {0, 1e-3, "s/sqrt(s)", "random walk of the clock's offset"});
}

void visit_errors(ConfigVisitor& v, VehicleLocaliser& l) {
  EstimatorRules& r = l.rules;
  v.number("timing_sigma_s", l.timing_sigma_s, {1e-7, 1, "s", "deviation of a measured travel time"});
  v.number("sound_speed_sigma", l.sound_speed_sigma, {0, 0.1, "", "relative deviation of the sound speed"});
  v.number("drift_m_per_sqrt_s", r.drift_m_per_sqrt_s,
           {1e-4, 100, "m/sqrt(s)", "error of dead reckoning: after t seconds this times sqrt(t)"});
  v.number("slip_m_per_sqrt_rad", r.slip_m_per_sqrt_rad,
           {0, 100, "m/sqrt(rad)", "error of dead reckoning in turns: after an angle this times its root"});
  v.number("current_sigma_mps", r.current_sigma_mps,
           {1e-4, 10, "m/s", "standard deviation of each component of the current at the start"});
  visit_clock_rules(v, r);
}

void visit_vehicle(ConfigVisitor& v, VehicleLocaliser& vehicle) {
  v.shared_with_others();
  v.text("name", vehicle.vehicle, {}, "");
  bus::integer_as(v, "id", vehicle.vehicle_id, {1, 2147483647, "", ""});
  v.vector3("start_ned_m", vehicle.start_ned_m, {-1e6, 1e6, "m", ""});
  if (!v.writing()) v.boolean("has_modem", vehicle.has_modem, "");
  if (!v.given("localiser")) return;
  v.when(vehicle.has_modem, "has_modem = true", [&] {
    v.section("localiser", "Localisation by ranges to beacons", [&](ConfigVisitor& section) {
      visit_ranging(section, vehicle);
      section.advanced([&] { visit_errors(section, vehicle); });
    });
  });
}

}  // namespace

void visit(ConfigVisitor& v, LocaliserConfig& config) {
  v.list(
      "vehicle", "A vehicle", config.vehicles.size(), [&](std::size_t n) { config.vehicles.resize(n); },
      [&](ConfigVisitor& item, std::size_t i) { visit_vehicle(item, config.vehicles[i]); });
  visit(v, config.clocks);
}

std::vector<Beacon> beacons_of(const LocaliserConfig& config, const VehicleLocaliser& vehicle) {
  std::vector<Beacon> beacons;
  std::istringstream names(vehicle.beacons);
  for (std::string name; names >> name;) {
    const auto found = std::find_if(config.vehicles.begin(), config.vehicles.end(),
                                    [&](const VehicleLocaliser& other) { return other.vehicle == name; });
    require(found != config.vehicles.end() && name != vehicle.vehicle,
            "vehicle " + vehicle.vehicle + ": localiser.beacons names '" + name +
                "'; allowed are other vehicles of the scenario, with spaces between");
    beacons.push_back({name, found->vehicle_id, found->start_ned_m});
  }
  return beacons;
}

}  // namespace halocline::clients
