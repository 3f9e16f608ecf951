// SPDX-License-Identifier: BSD-3-Clause
// A node in a process of its own: command line, transport, time source, loop, and an orderly end.
// Each program's main describes itself in a NodeProgram and calls run_node_program. SIGINT, SIGTERM and
// SIGHUP end the loop: messages that the bus has delivered are handled, the node takes its last step and
// publishes a final STATUS, and others get what they missed of it, in 0.6 s at most; exit code 0. A node in
// the middle of a step that takes longer ends there, 0.9 s after the signal: what it holds on disk serves as
// after SIGKILL. An error of the user (configuration, command line) prints one line per problem; exit code 2.
// A network that cannot be used, or on which another conductor runs: 69. Any other error: 1.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "bus/config/config.h"
#include "bus/node_identity.h"
#include "bus/runtime/node.h"
#include "bus/runtime/receive_filter.h"
#include "bus/runtime/scenario.h"
#include "bus/runtime/time_source.h"
#include "core/sim_time.h"

namespace halocline::bus {

// An option of one program's own: a flag, or a text.
struct ProgramOption {
  std::string name;  // "--log"
  std::string help;
  std::string* value = nullptr;
  bool* flag = nullptr;
  // Of a text that stands for keys of the scenario: its settings ("section.key=value"). Throws
  // InvalidArgument that names what is allowed.
  std::function<std::vector<std::string>(const std::string& value)> settings = nullptr;
  std::vector<std::string>* values = nullptr;  // of a text that may be given repeatedly
};

struct NodeProgram {
  std::string program;    // "halocline-channel-server"
  std::string purpose;    // one sentence
  std::string node_name;  // default for --name
  std::string interface;  // for --interface: the channels subscribed and published, one a line
  std::string example_scenario = "scenarios/seamount.toml";  // of --help
  TimeSourceKind time_source = TimeSourceKind::kConductor;
  Stage stage = Stage::kClients;  // its place in lockstep
  std::vector<ProgramOption> options = {};
  bool keeps_state = false;  // takes --journal: its node describes its state (Node::on_archive)
  // The name of the node when the command line gives none, called once the configuration is read; default:
  // node_name.
  std::function<std::string()> default_name = nullptr;

  // Describes the program's own sections of the scenario file: read from it, printed by --example and
  // --print-config.
  std::function<void(ConfigVisitor&)> visit_config = nullptr;
  // Makes the node after the configuration was read and checked.
  struct Context {
    lcm::LCM& lcm;
    NodeIdentity identity;
    const Scenario& scenario;
    const std::string& sync_url;
    bool in_lockstep = false;    // as a participant
    ConfigFile* file = nullptr;  // the scenario file, for checks that need more than it; null without one
    std::uint64_t config_digest = 0;  // of the version and the effective configuration; 0 in lockstep
    std::string lcm_url = {};         // of `lcm`; empty in lockstep
  };
  std::function<std::unique_ptr<Node>(const Context&)> make_node = nullptr;
  // Only for the program that makes the time itself; the others choose with --time-source.
  std::function<std::unique_ptr<TimeSource>(const Context&)> make_time_source = nullptr;
  // Called at the end of a node that stopped when asked to, while it exists: the exit code. Default: 0.
  std::function<int()> finish = nullptr;
  int exit_code_when_cut = 0;  // of a process that is ended in the middle of a step
  std::vector<std::pair<int, std::string>> other_exit_codes = {};  // of `finish`, and what each means
  // Another way to run than run_node: returns true when the command line selects it, after it has run.
  std::function<bool(const Context&)> run_otherwise = nullptr;
};

// As sysexits.h has it, EX_UNAVAILABLE.
inline constexpr int kExitConfiguration = 2, kExitNetwork = 69;

// Parses the command line, runs the node until a signal, and returns the exit code. Never throws.
[[nodiscard]] int run_node_program(int argc, char** argv, const NodeProgram& program);

// The loop alone. A node that is far behind the time steps by slices of simulation time, of which each takes
// about a tenth of a second. `should_stop` is called at least every 0.1 s. The conductor brings its own
// TimeSource. `filter`: of `lcm`, on which nothing else is received then; null for none.
void run_node(lcm::LCM& lcm, Node& node, TimeSource& time, const std::function<bool()>& should_stop,
              ReceiveFilter* filter = nullptr);

// From now on SIGINT, SIGTERM and, unless it is ignored, SIGHUP set a flag instead of ending the process.
void catch_stop_signals();
bool stop_requested();       // either came
bool interrupt_requested();  // SIGINT came: Ctrl-C

// Sleeps until the bus has something or `other_file` is readable (-1: none), `wake` (steady) has come, a stop
// signal, or a tenth of a second has passed. Returns what is readable.
struct Readable {
  bool bus = false;
  bool other = false;
};
Readable wait_for_bus(lcm::LCM& lcm, SimTime wake, int other_file = -1);
// Dispatches what the bus has delivered, up to a bound, so that a flood cannot keep a process from its work.
// Returns how many messages.
int dispatch_waiting(lcm::LCM& lcm);

// Both, one after the other, in fewer system calls.
void wait_and_dispatch(lcm::LCM& lcm, SimTime wake);

// From now on this thread's sleeps end when requested, not up to 50 us later (Linux' timer slack).
void sleep_precisely();

// Unix time.
SimTime wall_now();
// Nanoseconds since the process started; never goes back.
SimTime steady_now();

}  // namespace halocline::bus
