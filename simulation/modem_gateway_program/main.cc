// SPDX-License-Identifier: BSD-3-Clause
// Program halocline-modem-gateway: runs the emulated modem interfaces of clients/modem_gateway, and simulates
// the water for those that exchange waveforms.
#include <memory>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "bus/config/config.h"
#include "bus/runtime/node_process.h"
#include "clients/modem_gateway/gateway_config.h"
#include "clients/modem_gateway/gateway_node.h"
#include "clients/modem_gateway/protocols/sound_field.h"
#include "core/sim_time.h"
#include "simulation/composition.h"
#include "simulation/waveform/live_sea.h"

using halocline::SimDuration;
using halocline::bus::ConfigFile;
using halocline::bus::NodeProgram;
using halocline::modem_gateway::GatewayNode;
using halocline::modem_gateway::SoundFieldMaker;

namespace {

// Returns a maker of the scenario's water, for modem interfaces of waveforms; empty without a scenario. The
// file must outlive it.
SoundFieldMaker water_of(ConfigFile* file) {
  using namespace halocline::clients;
  if (file == nullptr) return {};
  return [file](halocline::bus::Bus& bus) {
    const ScenarioConfig config = load_scenario(*file, ScenarioUse::kWater);
    return live_sea_maker(config, make_terrain(config))(bus);
  };
}

}  // namespace

int main(int argc, char** argv) {
  halocline::modem_gateway::GatewayConfig config;
  std::vector<std::string> interfaces;
  std::string trace;
  NodeProgram program;
  program.program = "halocline-modem-gateway";
  program.purpose = "Lets hosts talk to simulated modems as to real ones, over TCP and serial lines.";
  program.node_name = "modem-gateway";
  program.keeps_state = true;
  program.interface =
      "receives:  CLOCK, RECEIPT.<vehicle>, RECEIVE.<vehicle>, MODEM_EVENT.<vehicle>, OUTCOME, "
      "USBL.<vehicle>,\n"
      "           SENSORS.<vehicle>, STATE.<vehicle>, BATTERY.<vehicle>, GPS.<vehicle>\n"
      "publishes: SEND.<vehicle>, LISTEN.<vehicle>, STATUS.<name>";
  program.options = {
      {.name = "--modem-interface",
       .help = "one more modem interface: VEHICLE=KIND:tcp:PORT or VEHICLE=KIND:pty:PATH (repeatable)",
       .values = &interfaces},
      {.name = "--trace",
       .help = "file of all that passes through the modem interfaces; -: stderr",
       .value = &trace}};
  program.visit_config = [&](halocline::bus::ConfigVisitor& v) { visit(v, config); };
  program.make_node = [&](const NodeProgram::Context& context) {
    config.rate = context.scenario.rate;
    config.origin_latitude_deg = context.scenario.origin_latitude_deg;
    config.origin_longitude_deg = context.scenario.origin_longitude_deg;
    for (const std::string& interface : interfaces) add_interface(config, interface);
    return std::make_unique<GatewayNode>(context.lcm, context.identity, config,
                                         context.in_lockstep ? GatewayNode::kLockstepPeriod : SimDuration(),
                                         trace, water_of(context.file));
  };
  return halocline::bus::run_node_program(argc, argv, program);
}
