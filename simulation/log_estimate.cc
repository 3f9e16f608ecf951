// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/log_estimate.h"

#include <algorithm>
#include <cmath>

#include "bathymetry/rasters/terrain_recipe.h"
#include "channel_server/channel_server_config.h"
#include "clients/onboard/autopilot/autopilot_config.h"
#include "clients/onboard/localiser/localiser_config.h"
#include "clients/onboard/traffic/traffic_config.h"
#include "core/sim_time.h"
#include "vehicle_sim/sensors/sensor_settings.h"
#include "vehicle_sim/vehicle_sim_config.h"

namespace halocline::clients {
namespace {

// Bytes of each message in a log, including its channel's name.
constexpr double kClock = 82, kStatus = 230, kState = 180, kSensors = 209, kCommand = 130, kEstimate = 249,
                 kDvl = 170, kGps = 130, kSonar = 90, kSonarRay = 8, kSend = 80, kReceipt = 106,
                 kOutcome = 262, kReceive = 155, kLinks = 80, kLink = 168, kActivity = 112, kTerrain = 47'000,
                 kScenario = 1500, kScenarioVehicle = 400;
// Bytes of a RAY_QUERY with its RAY_REPLY, of each ray in both together, and of each depth in a tile.
constexpr double kRayQuery = 270, kRay = 65, kTileDepth = 10;
constexpr int kNodes = 7, kBeamsOfDvl = 4;
constexpr double kReceivedShare = 0.3;
// Depths that a link requests for each step along it, once.
constexpr double kDepthsAStep = 16;
constexpr double kScenarioPeriod_s = 60;

double per_second(SimDuration period) { return period > SimDuration() ? 1 / period.seconds() : 0; }

double of_sensors(const vehicle_sim::VehicleSimConfig& config, const vehicle_sim::SensorSettings& s) {
  const double basic = per_second(config.sensor_period) * (kSensors + kRay);
  const double dvl = per_second(s.dvl.period) * (kDvl + kRayQuery + kBeamsOfDvl * kRay);
  const double sonar = per_second(s.sonar.period) * (kSonar + kRayQuery + s.sonar.rays * (kRay + kSonarRay));
  return basic + dvl + sonar + per_second(s.gps.period) * kGps;
}

double of_vehicles(const ScenarioConfig& config) {
  double bytes = per_second(config.vehicle_sim.sensor_period) * kRayQuery;
  for (std::size_t i = 0; i < config.scenario.vehicles.size(); ++i) {
    const vehicle_sim::VehicleSensors& own = config.vehicle_sim.vehicles.at(i);
    bytes += per_second(config.vehicle_sim.state_period) * kState;
    bytes += of_sensors(config.vehicle_sim, own.own ? own.sensors : config.vehicle_sim.sensors);
    if (config.autopilot.vehicles.at(i).is_piloted())
      bytes += per_second(config.autopilot.command_period) * kCommand + kActivity;
  }
  return bytes;
}

double of_packets(const ScenarioConfig& config) {
  const auto others = static_cast<double>(config.scenario.vehicles.size()) - 1;
  const auto packets = [&](SimDuration period, double payload) {
    return per_second(period) *
           (kSend + kReceipt + payload + others * (kOutcome + kReceivedShare * (kReceive + payload)));
  };
  double bytes = 0;
  for (const VehicleTraffic& traffic : config.traffic.vehicles)
    bytes += packets(traffic.period, traffic.payload_bytes);
  for (const PilotConfig& pilot : config.autopilot.vehicles) bytes += packets(pilot.broadcast.period, 17);
  for (const VehicleLocaliser& vehicle : config.localiser.vehicles) {
    bytes += 2 * packets(vehicle.ping_period, 0);  // the ping and its reply
    if (!vehicle.beacons.empty()) bytes += per_second(config.localiser.estimate_period) * kEstimate;
  }
  return bytes;
}

double of_links(const ScenarioConfig& config) {
  const auto n = static_cast<double>(config.scenario.vehicles.size());
  const double links = n * std::max(n - 1, 0.0);
  return per_second(config.channel_server.rules.link_period) * (n * kLinks + links * kLink);
}

// Bytes written once per run: the terrain, and the depths below links, which are no more than the terrain
// has.
double once(const ScenarioConfig& config) {
  const double spacing_m = config.channel_server.rules.seabed.spacing_m;
  const auto& vehicles = config.scenario.vehicles;
  double steps = 0;
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k)
      steps += (vehicles[i].start_ned_m - vehicles[k].start_ned_m).head<2>().norm() / spacing_m;
  }
  const double lattice =
      config.terrain.domain.size_north_m * config.terrain.domain.size_east_m / (spacing_m * spacing_m);
  return kTerrain + kTileDepth * std::min(kDepthsAStep * steps, lattice);
}

}  // namespace

double estimated_log_bytes(const ScenarioConfig& config) {
  const double scenario = kScenario + kScenarioVehicle * static_cast<double>(config.scenario.vehicles.size());
  const double nodes =
      per_second(config.scenario.clock_period) * kClock + kNodes * kStatus + scenario / kScenarioPeriod_s;
  return once(config) + config.scenario.duration.seconds() *
                            (nodes + of_vehicles(config) + of_packets(config) + of_links(config));
}

double estimated_memory_bytes(const ScenarioConfig& config) { return bathymetry::memory_of(config.terrain); }

}  // namespace halocline::clients
