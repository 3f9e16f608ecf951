// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/composition.h"

#include <algorithm>
#include <utility>

#include "bathymetry/bathymetry_config.h"
#include "bathymetry/bathymetry_node.h"
#include "bus/transport/node_identity.h"
#include "channel_server/channel_server_node.h"
#include "channel_server/vehicles/shard.h"
#include "clients/modem_gateway/gateway_node.h"
#include "clients/onboard/autopilot/autopilot_node.h"
#include "clients/onboard/localiser/localiser_node.h"
#include "clients/onboard/networks/network_node.h"
#include "clients/onboard/traffic/traffic_node.h"
#include "conductor/conductor_node.h"
#include "core/check.h"
#include "core/frames.h"
#include "simulation/scenario_checks.h"
#include "vehicle_sim/vehicle_block.h"
#include "vehicle_sim/vehicle_sim_node.h"
#include "vehicle_sim/world/terrain_seabed.h"

namespace halocline::clients {
void visit(bus::ConfigVisitor& v, ScenarioConfig& config) {
  bus::visit(v, config.scenario);
  bathymetry::visit(v, config.terrain);
  channel_server::visit(v, config.channel_server);
  vehicle_sim::visit(v, config.vehicle_sim);
  visit(v, config.autopilot);
  visit(v, config.traffic);
  visit(v, config.localiser);
  networks::visit(v, config.network);
  modem_gateway::visit(v, config.gateway);
  visit(v, config.uncertainty);
}

namespace {

// Sets the noise place that is left to the depth of the water, as the channel server's main does.
void set_noise_place(ScenarioConfig& config) {
  channel_server::EnvironmentConfig& environment = config.channel_server.environment;
  if (!needs_depth(environment)) return;
  const bus::Scenario& scenario = config.scenario;
  double depth_m = 0;
  try {
    depth_m =
        mean_water_depth_m(config.terrain, {scenario.origin_latitude_deg, scenario.origin_longitude_deg},
                           scenario.sea_surface_z_m);
  } catch (const InvalidArgument&) {
    // A terrain that cannot be made is refused where it is used.
  }
  use_depth(depth_m, environment);
}

// Reads the sections and makes all checks that need no terrain; findings are collected in `file`.
ScenarioConfig read_scenario(bus::ConfigFile& file, ScenarioUse use) {
  ScenarioConfig config;
  file.read([&](bus::ConfigVisitor& v) { visit(v, config); });
  file.check(/*whole_file=*/true);
  config.scenario.configuration = bus::configuration_of(file);
  set_noise_place(config);
  check_water(config, file);
  if (use == ScenarioUse::kRun) check_missions(config, file);
  return config;
}

std::optional<bathymetry::PreparedTerrain> try_terrain(const ScenarioConfig& config, bus::ConfigFile& file) {
  try {
    return make_terrain(config);
  } catch (const InvalidArgument& error) {
    const bool by_raster = config.terrain.kind == bathymetry::TerrainKind::kRaster;
    file.refuse(by_raster ? "terrain.raster.path" : "terrain",
                by_raster ? config.terrain.raster.path.given() : "", error.what());
    return std::nullopt;
  }
}

}  // namespace

ScenarioConfig load_scenario(const std::string& path, const std::vector<std::string>& overrides,
                             ScenarioUse use) {
  auto file = bus::ConfigFile::load(path, overrides);
  return load_scenario(file, use);
}

ScenarioConfig load_scenario(bus::ConfigFile& file, ScenarioUse use) {
  ScenarioConfig config = read_scenario(file, use);
  file.check_findings();
  return config;
}

CheckedScenario load_checked(const std::string& path, const std::vector<std::string>& overrides) {
  auto file = bus::ConfigFile::load(path, overrides);
  ScenarioConfig config = read_scenario(file, ScenarioUse::kRun);
  auto terrain = try_terrain(config, file);
  if (terrain) check_on_terrain(config, *terrain, file);
  file.check_findings();
  return {std::move(config), std::move(*terrain), file.warnings(), file.inputs()};
}

std::string effective_toml(const ScenarioConfig& config) {
  ScenarioConfig written = config;
  return bus::to_toml([&](bus::ConfigVisitor& v) { visit(v, written); }, /*with_comments=*/false);
}

std::string portable_toml(const ScenarioConfig& config) {
  ScenarioConfig written = config;
  return bus::to_portable_toml([&](bus::ConfigVisitor& v) { visit(v, written); });
}

std::string key_list(bus::KeyClass key_class) {
  ScenarioConfig config;
  config.scenario.vehicles.resize(1);
  config.scenario.tide.constituents.resize(1);
  config.scenario.vehicles[0].name = "auv-1";
  config.scenario.vehicles[0].id = 1;
  config.scenario.vehicles[0].battery.emplace();
  config.channel_server.vehicles.resize(1);
  config.channel_server.rules.medium.extra_loss.resize(1);
  set_slow_sea(config.channel_server);
  config.channel_server.vehicles[0].clock.emplace();
  config.channel_server.vehicles[0].noise.emplace();
  config.vehicle_sim.vehicles.resize(1);
  config.vehicle_sim.vehicles[0].own = true;
  config.vehicle_sim.tethers.resize(1);
  config.vehicle_sim.tethers[0].vehicle = "auv-1";
  config.vehicle_sim.faults.resize(1);
  config.vehicle_sim.faults[0].vehicle = "auv-1";
  config.vehicle_sim.faults[0].fault.angle_rad = 0;
  config.channel_server.changes = {{600, 8, 0.3, 0, channel_server::ProfileConfig(), 10}};
  config.autopilot.vehicles.resize(1);
  config.autopilot.vehicles[0].behaviours.resize(1);
  config.autopilot.vehicles[0].behaviours[0].waypoints = {Vec3(100, 0, 10)};
  config.traffic.vehicles.resize(1);
  config.localiser.vehicles.resize(1);
  config.network.members.resize(1);
  config.gateway.interfaces.resize(1);
  config.uncertainty.noise_db = Uncertainty::kNoiseDb;
  config.gateway.interfaces[0] = {"auv-1", 1, "nm3", modem_gateway::place_of("tcp:9600"), "", ""};
  return bus::to_key_list([&](bus::ConfigVisitor& v) { visit(v, config); }, key_class);
}

bathymetry::PreparedTerrain make_terrain(const ScenarioConfig& config) {
  return prepare_terrain(config.terrain,
                         {config.scenario.origin_latitude_deg, config.scenario.origin_longitude_deg});
}

template <class NodeType, class... Arguments>
void Composition::add(bus::Stage stage, const std::string& name, Arguments&&... arguments) {
  const bus::NodeIdentity identity{name, bus::session_of(seed_, name), stage};
  owned_.push_back(std::make_unique<NodeType>(lcm_, identity, std::forward<Arguments>(arguments)...));
  order_.push_back(owned_.back().get());
}

Composition::Composition(lcm::LCM& lcm, const ScenarioConfig& config, Kind kind, bus::Node* recorded,
                         std::optional<bathymetry::PreparedTerrain> terrain,
                         const modem_gateway::SoundFieldMaker& make_sound)
    : lcm_(lcm),
      seed_(config.scenario.seed),
      threads_(std::max(config.vehicle_sim.threads, config.channel_server.rules.threads)),
      terrain_(terrain ? std::move(*terrain) : make_terrain(config)) {
  // A lockstep run is paced by no wall clock: the clock announces rate 0.
  add<conductor::ConductorNode>(bus::Stage::kTime, "conductor", config.scenario.clock_period, 0.0);
  add<bathymetry::BathymetryNode>(bus::Stage::kTerrain, "bathymetry", terrain_.terrain, terrain_.summary);
  if (kind == kReplay) {
    order_.push_back(recorded);
  } else {
    add_vehicle_sims(config);
    add<AutopilotNode>(bus::Stage::kPilots, "autopilot", config.autopilot);
    add<TrafficNode>(bus::Stage::kTraffic, "traffic", config.traffic);
    if (config.network.rules.mac != networks::MacKind::kNone)
      add<networks::NetworkNode>(bus::Stage::kTraffic, "network", config.network, config.scenario.seed);
    add<LocaliserNode>(bus::Stage::kClients, "localiser", config.localiser);
    add_gateway(config, make_sound);
  }
  add_channel_servers(config);
}

void Composition::add_vehicle_sims(const ScenarioConfig& config) {
  const auto seabed = std::make_shared<vehicle_sim::TerrainSeabed>(terrain_.terrain);
  vehicle_sim::VehicleSimConfig all = config.vehicle_sim;
  for (all.block.index = 0; all.block.index < all.block.count; ++all.block.index) {
    const auto [scenario, own] = part_of_block(config.scenario, all);
    add<vehicle_sim::VehicleSimNode>(bus::Stage::kVehicles, node_name_of(all.block), scenario, own, seabed);
  }
}

void Composition::add_gateway(const ScenarioConfig& config,
                              const modem_gateway::SoundFieldMaker& make_sound) {
  if (config.gateway.interfaces.empty()) return;
  modem_gateway::GatewayConfig gateway = config.gateway;
  gateway.origin_latitude_deg = config.scenario.origin_latitude_deg;
  gateway.origin_longitude_deg = config.scenario.origin_longitude_deg;
  add<modem_gateway::GatewayNode>(bus::Stage::kClients, "modem-gateway", gateway,
                                  modem_gateway::GatewayNode::kLockstepPeriod, "", make_sound);
}

void Composition::add_channel_servers(const ScenarioConfig& config) {
  channel_server::ChannelServerConfig server = config.channel_server;
  channel_server::Shard& shard = server.rules.medium.shard;
  for (shard.index = 0; shard.index < shard.count; ++shard.index) {
    const std::string name = "channel-server" + (shard.is_alone() ? "" : "-" + std::to_string(shard.index));
    const bus::NodeIdentity identity{name, bus::session_of(seed_, name), bus::Stage::kChannel};
    owned_.push_back(channel_server::make_channel_server(lcm_, identity, server, config.scenario));
    order_.push_back(owned_.back().get());
  }
}

}  // namespace halocline::clients
