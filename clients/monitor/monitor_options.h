// SPDX-License-Identifier: BSD-3-Clause
// The command line of halocline-monitor.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "clients/monitor/web/web_server.h"

namespace halocline::monitor {

struct MonitorOptions {
  std::vector<std::string> logs;  // one log, or its parts in order; empty: the bus
  std::string lcm_url;            // empty: the default
  int network = 0;                // a process in whose network the bus is; 0: in this one's
  std::string accept;             // hosts of the bus (bus/runtime/receive_filter.h)
  std::string scenario;           // configuration of a log; empty: what the log holds, or the file beside it
  double history_s = 3600;        // of a bus: what is older is dropped
  bool may_command = false;
  WebServer::Options web;
};

// Empty when the command line only requested output (--help, --version), which was printed. Throws
// InvalidArgument for a wrong one.
[[nodiscard]] std::optional<MonitorOptions> parse_monitor_command_line(int argc, char** argv);

}  // namespace halocline::monitor
