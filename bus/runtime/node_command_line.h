// SPDX-License-Identifier: BSD-3-Clause
// Command line common to all node programs.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/config/config.h"
#include "bus/config/scenario.h"
#include "bus/runtime/node_process.h"
#include "bus/runtime/time_source.h"
#include "bus/transport/event_log.h"
#include "bus/transport/node_identity.h"

namespace halocline::bus {

// Settings from the command line and the scenario file.
struct NodeRun {
  NodeIdentity identity;
  Scenario scenario;
  std::shared_ptr<ConfigFile> file;  // null if none is given
  std::string lcm_url;               // empty: the default
  std::string sync_url;
  TimeSourceKind time_source = TimeSourceKind::kConductor;
  LogLevel log_level = LogLevel::kInfo;
  std::string journal;              // path of the node's state journal; empty: none
  std::uint64_t config_digest = 0;  // covers the version and the effective configuration
};

// Returns nothing when the command line only requested output (--help, --example, --interface, --version,
// --print-config), which was printed. Throws InvalidArgument for a wrong command line and ConfigErrors for a
// wrong file.
[[nodiscard]] std::optional<NodeRun> parse_node_command_line(int argc, char** argv,
                                                             const NodeProgram& program);

// Converts the value "i/n" of an option (part i of n) to settings of two keys of the scenario. Throws
// InvalidArgument that names the permitted values.
std::vector<std::string> part_settings(const std::string& option, const std::string& value,
                                       const std::string& index_key, const std::string& count_key);

}  // namespace halocline::bus
