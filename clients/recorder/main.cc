// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include <unistd.h>

#include "bus/config/config.h"
#include "bus/runtime/node_process.h"
#include "clients/recorder/recorded_file.h"
#include "clients/recorder/recorder_node.h"
#include "core/check.h"

using halocline::bus::NodeProgram;
using halocline::clients::RecordedFile;
using halocline::clients::RecorderNode;

int main(int argc, char** argv) {
  std::string path;
  bool replaces = false, appends = false;
  std::optional<RecordedFile> file;
  RecorderNode* node = nullptr;
  NodeProgram program;
  program.program = "halocline-recorder";
  program.purpose = "Records every message of the bus in an LCM log, and requests what it misses.";
  program.node_name = "recorder-<process id>";
  program.default_name = [] { return "recorder-" + std::to_string(getpid()); };
  program.example_scenario = "scenarios/seamount.toml --log results/seamount.lcmlog";
  program.other_exit_codes = {
      {RecorderNode::kExitLacking, "the log lacks messages: the last line says of whom"}};
  program.interface =
      "receives:  every channel\n"
      "publishes: REPAIR_REQUEST, HEARTBEAT.<name>, STATUS.<name>";
  program.options = {{.name = "--log", .help = "the LCM log to be written", .value = &path},
                     {.name = "--force", .help = "replace a log that is there", .flag = &replaces},
                     {.name = "--append",
                      .help = "go on behind the log of a recorder that was killed, and request what it lacks",
                      .flag = &appends}};
  program.make_node = [&](const NodeProgram::Context& context) {
    halocline::require(!context.in_lockstep,
                       "in lockstep the conductor writes the log: halocline-conductor --log");
    if (context.file != nullptr) context.file->require_no_input(path);
    halocline::require(!replaces || !appends, "--force and --append; allowed is one of them");
    using Existing = RecordedFile::Existing;
    file.emplace(path, replaces ? Existing::kReplace : appends ? Existing::kAppend : Existing::kRefuse);
    auto made = std::make_unique<RecorderNode>(context.lcm, context.identity, *file, std::cout);
    node = made.get();
    return made;
  };
  program.finish = [&] { return node->finish(); };
  program.exit_code_when_cut = 1;
  return halocline::bus::run_node_program(argc, argv, program);
}
