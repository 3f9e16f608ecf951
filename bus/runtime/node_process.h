// SPDX-License-Identifier: BSD-3-Clause
// Runs a node in a separate process: command line, transport, time source, loop, and orderly shutdown.
//
// Each program's main describes itself in a NodeProgram and calls run_node_program(). SIGINT, SIGTERM and
// SIGHUP end the loop: delivered messages are handled, the node takes its last step and publishes a final
// STATUS, and others can request lost messages for at most 0.6 s; exit code 0. A node in the middle of a
// longer step is ended 0.9 s after the signal; its files on disk are then as valid as after SIGKILL. An error
// of the user (configuration, command line) prints one line per problem; exit code 2. A network that cannot
// be used, or on which another conductor runs: 69. Any other error: 1.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "bus/config/config.h"
#include "bus/config/scenario.h"
#include "bus/runtime/node.h"
#include "bus/runtime/time_source.h"
#include "bus/transport/node_identity.h"
#include "bus/transport/receive_filter.h"
#include "core/sim_time.h"

namespace halocline::bus {

// Option of a single program: a flag or a text.
struct ProgramOption {
  std::string name;  // "--log"
  std::string help;
  std::string* value = nullptr;
  bool* flag = nullptr;
  // Converts a text to settings of the scenario ("section.key=value"), for an option that sets keys. Throws
  // InvalidArgument that names the permitted values.
  std::function<std::vector<std::string>(const std::string& value)> settings = nullptr;
  std::vector<std::string>* values = nullptr;  // for a text that may be given repeatedly
};

struct NodeProgram {
  std::string program;    // "halocline-channel-server"
  std::string purpose;    // one sentence
  std::string node_name;  // default for --name
  std::string interface;  // for --interface: the channels subscribed and published, one per line
  std::string example_scenario = "scenarios/seamount.toml";  // shown by --help
  TimeSourceKind time_source = TimeSourceKind::kConductor;
  Stage stage = Stage::kClients;  // position in the order of lockstep
  std::vector<ProgramOption> options = {};
  bool keeps_state = false;  // accepts --journal: the node archives its state (Node::on_archive)
  // Name of the node when the command line gives none, called once the configuration is read; default:
  // node_name.
  std::function<std::string()> default_name = nullptr;

  // Describes the program's own sections of the scenario file; used to read it, and for --example and
  // --print-config.
  std::function<void(ConfigVisitor&)> visit_config = nullptr;
  // Makes the node after the configuration was read and checked.
  struct Context {
    lcm::LCM& lcm;
    NodeIdentity identity;
    const Scenario& scenario;
    const std::string& sync_url;
    bool in_lockstep = false;         // true for a lockstep participant
    ConfigFile* file = nullptr;       // the scenario file, for further checks; null if none is given
    std::uint64_t config_digest = 0;  // covers version and effective configuration; 0 in lockstep
    std::string lcm_url = {};         // URL of `lcm`; empty in lockstep
  };
  std::function<std::unique_ptr<Node>(const Context&)> make_node = nullptr;
  // Only for the program that generates the time itself; the others choose with --time-source.
  std::function<std::unique_ptr<TimeSource>(const Context&)> make_time_source = nullptr;
  // Returns the exit code of a node that stopped on request; called while the node exists. Default: 0.
  std::function<int()> finish = nullptr;
  int exit_code_when_cut = 0;  // exit code of a process that is ended in the middle of a step
  // Exit codes of `finish` with their meanings.
  std::vector<std::pair<int, std::string>> other_exit_codes = {};
  // Alternative to run_node(): returns true after it has run, if the command line selects it.
  std::function<bool(const Context&)> run_otherwise = nullptr;
};

// Exit codes; 69 is EX_UNAVAILABLE of sysexits.h.
inline constexpr int kExitConfiguration = 2, kExitNetwork = 69;

// Parses the command line, runs the node until a signal, and returns the exit code. Never throws.
[[nodiscard]] int run_node_program(int argc, char** argv, const NodeProgram& program);

// Runs a program whose node is made of its configuration alone: fills in visit_config and make_node.
template <class Config, class ConfiguredNode>
[[nodiscard]] int run_node_program(int argc, char** argv, NodeProgram program) {
  Config config;
  program.visit_config = [&](ConfigVisitor& v) { visit(v, config); };
  program.make_node = [&](const NodeProgram::Context& context) {
    return std::make_unique<ConfiguredNode>(context.lcm, context.identity, config);
  };
  return run_node_program(argc, argv, program);
}

// Loop of a node. A node that is far behind the time steps by slices of simulation time, each of which takes
// about a tenth of a second to compute. `should_stop` is called at least every 0.1 s. The conductor has a
// TimeSource of its own. `filter` is attached to `lcm`, which then receives nothing else; null: none.
void run_node(lcm::LCM& lcm, Node& node, TimeSource& time, const std::function<bool()>& should_stop,
              ReceiveFilter* filter = nullptr);

// Makes SIGINT, SIGTERM and, unless it is ignored, SIGHUP set a flag instead of ending the process.
void catch_stop_signals();
bool stop_requested();       // any of these signals came
bool interrupt_requested();  // SIGINT came: Ctrl-C

// Sleeps until the bus has a message, `other_file` is readable (-1: none), `wake` (steady) has come, a stop
// signal arrives, or a tenth of a second has passed. Returns the readable sources.
struct Readable {
  bool bus = false;
  bool other = false;
};
Readable wait_for_bus(lcm::LCM& lcm, SimTime wake, int other_file = -1);
// Dispatches delivered messages, up to a limit, so that a flood cannot keep a process from its work. Returns
// how many.
int dispatch_waiting(lcm::LCM& lcm);

// Waits and dispatches as wait_for_bus() and dispatch_waiting() do, with fewer system calls.
void wait_and_dispatch(lcm::LCM& lcm, SimTime wake);

// Makes this thread's sleeps end when requested, not up to 50 us later (timer slack of Linux).
void sleep_precisely();

// Returns Unix time.
SimTime wall_now();
// Returns the time since the process started, ns; never decreases.
SimTime steady_now();

}  // namespace halocline::bus
