// SPDX-License-Identifier: BSD-3-Clause
// A whole scenario in one process: its file, read and checked as a whole, and the nodes that run it.
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
#include "bus/config/scenario.h"
#include "bus/runtime/node.h"
#include "channel_server/channel_server_config.h"
#include "clients/modem_gateway/gateway_config.h"
#include "clients/modem_gateway/protocols/sound_field.h"
#include "clients/onboard/autopilot/autopilot_config.h"
#include "clients/onboard/localiser/localiser_config.h"
#include "clients/onboard/networks/network_config.h"
#include "clients/onboard/traffic/traffic_config.h"
#include "simulation/uncertainty_config.h"
#include "vehicle_sim/vehicle_sim_config.h"

namespace halocline::clients {

// Configuration of a scenario: every section of its file.
struct ScenarioConfig {
  bus::Scenario scenario;
  bathymetry::TerrainRecipe terrain;
  vehicle_sim::VehicleSimConfig vehicle_sim;
  channel_server::ChannelServerConfig channel_server;
  AutopilotConfig autopilot;
  TrafficConfig traffic;
  LocaliserConfig localiser;
  networks::NetworkConfig network;       // an example client; runs when it names a protocol
  modem_gateway::GatewayConfig gateway;  // runs when there are modem interfaces
  Uncertainty uncertainty;               // of ensembles
};

void visit(bus::ConfigVisitor& v, ScenarioConfig& config);

// Reads a scenario. Throws bus::ConfigErrors with everything that is wrong with the file: within its
// sections, between them, and keys that no program reads. Checks that need the terrain are left out
// (load_checked() makes them). kWater, for a link or the replay of a log, uses only the water of the scenario
// and also leaves out the checks of missions and traffic.
enum class ScenarioUse { kRun, kWater };
ScenarioConfig load_scenario(const std::string& path, const std::vector<std::string>& overrides,
                             ScenarioUse use = ScenarioUse::kRun);
ScenarioConfig load_scenario(bus::ConfigFile& file, ScenarioUse use);

// Scenario that passed all checks, those on its terrain included (scenario_checks.h).
struct CheckedScenario {
  ScenarioConfig config;
  bathymetry::PreparedTerrain terrain;
  std::vector<std::string> warnings;  // about settings that are probably mistakes, one line each
  std::vector<std::string> inputs;    // files that were read: the scenario, and those that it names
};

// Reads a scenario as load_scenario() does, prepares its terrain and makes the checks that need it.
CheckedScenario load_checked(const std::string& path, const std::vector<std::string>& overrides);

// Returns the configuration as a scenario file of its own: every effective key with its value, and files by
// their absolute paths.
std::string effective_toml(const ScenarioConfig& config);

// Returns the effective configuration together with the files that it names (bus/config/carried_files.h), so
// that it can be used on any machine.
std::string portable_toml(const ScenarioConfig& config);

// Returns the keys of one class with their defaults and meanings, for one vehicle. The common keys are a
// valid scenario file.
std::string key_list(bus::KeyClass key_class);

// Prepares the terrain of a scenario; throws InvalidArgument when a raster cannot be read.
bathymetry::PreparedTerrain make_terrain(const ScenarioConfig& config);

// Nodes of a scenario in the order in which they step.
class Composition {
 public:
  // Selects the nodes: kRun creates all of them; kReplay creates the conductor, the bathymetry and the
  // channel servers beside `recorded`, which publishes the states and transmissions of a log.
  enum Kind { kRun, kReplay };

  // Creates the nodes. Their sessions are derived from the scenario's seed and their names. `recorded` steps
  // instead of the vehicle simulator and must outlive the composition. The terrain is prepared unless it
  // is given. `make_sound` is needed for modem interfaces that exchange waveforms.
  Composition(lcm::LCM& lcm, const ScenarioConfig& config, Kind kind, bus::Node* recorded = nullptr,
              std::optional<bathymetry::PreparedTerrain> terrain = {},
              const modem_gateway::SoundFieldMaker& make_sound = {});

  // Returns the nodes in the order in which they step: vehicle simulators before the pilots of their
  // vehicles, the channel servers last.
  std::vector<bus::Node*> nodes() const { return order_; }
  // Returns the number of threads for nodes of one stage (blocks of vehicles, shards of servers): as many as
  // a single one of them may use.
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
