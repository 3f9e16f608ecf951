// SPDX-License-Identifier: BSD-3-Clause
// Command line of halocline-monitor.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "viewer/web/web_server.h"

namespace halocline::monitor {

struct MonitorOptions {
  std::vector<std::string> logs;  // one log, or its parts in order; empty: the bus
  std::string lcm_url;            // empty: the default URL
  int network = 0;                // process in whose network namespace the bus is; 0: the monitor's own
  std::string accept;             // hosts of the bus (bus/transport/receive_filter.h)
  std::string scenario;           // configuration of a log; empty: the one in the log or beside it
  double history_s = 3600;        // age beyond which messages of a bus are dropped, s
  bool may_command = false;
  WebServer::Options web;
};

// Returns nothing when the command line only requested output (--help, --version), which was printed. Throws
// InvalidArgument for an invalid command line.
[[nodiscard]] std::optional<MonitorOptions> parse_monitor_command_line(int argc, char** argv);

}  // namespace halocline::monitor
