// SPDX-License-Identifier: BSD-3-Clause
// The command line that all node programs share.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/config/config.h"
#include "bus/event_log.h"
#include "bus/node_identity.h"
#include "bus/runtime/node_process.h"
#include "bus/runtime/scenario.h"
#include "bus/runtime/time_source.h"

namespace halocline::bus {

// The settings of the command line and the scenario file.
struct NodeRun {
  NodeIdentity identity;
  Scenario scenario;
  std::shared_ptr<ConfigFile> file;  // null without one
  std::string lcm_url;               // empty: the default
  std::string sync_url;
  TimeSourceKind time_source = TimeSourceKind::kConductor;
  LogLevel log_level = LogLevel::kInfo;
  std::string journal;              // where the node keeps its state; empty: nowhere
  std::uint64_t config_digest = 0;  // of the version and the effective configuration
};

// Empty when the command line only requested output (--help, --example, --interface, --version,
// --print-config), which was printed. Throws InvalidArgument for a wrong command line and ConfigErrors for a
// wrong file.
[[nodiscard]] std::optional<NodeRun> parse_node_command_line(int argc, char** argv,
                                                             const NodeProgram& program);

// "i/n" of an option, part i of n, as settings of two keys of the scenario. Throws InvalidArgument that names
// what is allowed.
std::vector<std::string> part_settings(const std::string& option, const std::string& value,
                                       const std::string& index_key, const std::string& count_key);

}  // namespace halocline::bus
