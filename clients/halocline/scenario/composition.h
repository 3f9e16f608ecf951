// SPDX-License-Identifier: BSD-3-Clause
// A whole scenario in one place: its file read and checked as a whole, and the nodes it is made of.
//
//   const ScenarioConfig config = load_scenario("scenarios/seamount.toml", {"modem.source_level_db=170"});
//   lcm::LCM lcm("memq://");
//   Composition all(lcm, config, Composition::kRun);
//   bus::LockstepRunner runner(all.nodes());
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bathymetry/rasters/terrain_recipe.h"
#include "bus/config/config.h"
#include "bus/runtime/node.h"
#include "bus/runtime/scenario.h"
#include "channel_server/channel_server_config.h"
#include "clients/autopilot/autopilot_config.h"
#include "clients/examples/networks/network_config.h"
#include "clients/localiser/localiser_config.h"
#include "clients/modem_gateway/gateway_config.h"
#include "clients/modem_gateway/protocols/sound_field.h"
#include "clients/traffic/traffic_config.h"
#include "vehicle_sim/vehicle_sim_config.h"

namespace halocline::clients {

// Every section of a scenario file.
struct ScenarioConfig {
  bus::Scenario scenario;
  bathymetry::TerrainRecipe terrain;
  vehicle_sim::VehicleSimConfig vehicle_sim;
  channel_server::ChannelServerConfig channel_server;
  AutopilotConfig autopilot;
  TrafficConfig traffic;
  LocaliserConfig localiser;
  networks::NetworkConfig network;       // an example client; runs where it names a protocol
  modem_gateway::GatewayConfig gateway;  // runs where there are doors
};

void visit(bus::ConfigVisitor& v, ScenarioConfig& config);

// Throws bus::ConfigErrors with everything that is wrong with the file: in its sections, between them, and
// keys that no program reads. What takes the terrain is left out; so are missions and traffic where the
// scenario stands for its water alone, as for a link or the replay of a log.
enum class ScenarioUse { kRun, kWater };
ScenarioConfig load_scenario(const std::string& path, const std::vector<std::string>& overrides,
                             ScenarioUse use = ScenarioUse::kRun);
ScenarioConfig load_scenario(bus::ConfigFile& file, ScenarioUse use);

// A scenario that makes sense on its terrain (scenario_checks.h).
struct CheckedScenario {
  ScenarioConfig config;
  bathymetry::PreparedTerrain terrain;
  std::vector<std::string> warnings;  // of what may be meant, one line each
};

// The same with what takes the terrain.
CheckedScenario load_checked(const std::string& path, const std::vector<std::string>& overrides);

// The configuration as a scenario file of its own: every key that counts with its value; files by their
// absolute paths.
std::string effective_toml(const ScenarioConfig& config);

// The same with the files that it names (bus/config/carried_files.h), so that it may be sent anywhere.
std::string portable_toml(const ScenarioConfig& config);

// Every key with its default and its meaning, with one vehicle.
std::string commented_toml();

// The seabed; throws InvalidArgument when a raster cannot be read.
bathymetry::PreparedTerrain make_terrain(const ScenarioConfig& config);

class Composition {
 public:
  // Which nodes: all of a run; or those that stay beside a recorded log, whose states and transmissions come
  // from `recorded`.
  enum Kind { kRun, kReplay };

  // Sessions are made of the scenario's seed and the nodes' names. `recorded` steps where the vehicle
  // simulator would; it must outlive the composition. The terrain is made unless it is given. `make_sound`:
  // for doors of waveforms.
  Composition(lcm::LCM& lcm, const ScenarioConfig& config, Kind kind, bus::Node* recorded = nullptr,
              std::optional<bathymetry::PreparedTerrain> terrain = {},
              const modem_gateway::SoundFieldMaker& make_sound = {});

  // In the order in which they step: who moves vehicles before who pilots them, the channel server last.
  std::vector<bus::Node*> nodes() const { return order_; }
  // For nodes of one stage, blocks of vehicles or shards: as many as one of them may use by itself.
  int threads() const { return threads_; }
  const bathymetry::PreparedTerrain& terrain() const { return terrain_; }

 private:
  template <class NodeType, class... Arguments>
  void add(bus::Stage stage, const std::string& name, Arguments&&... arguments);
  void add_vehicle_sims(const ScenarioConfig& config);
  void add_gateway(const ScenarioConfig& config, const modem_gateway::SoundFieldMaker& make_sound);
  void add_channel_servers(const ScenarioConfig& config);

  lcm::LCM& lcm_;
  std::uint64_t seed_;
  int threads_;
  bathymetry::PreparedTerrain terrain_;
  std::vector<std::unique_ptr<bus::Node>> owned_;
  std::vector<bus::Node*> order_;
};

}  // namespace halocline::clients
