// SPDX-License-Identifier: BSD-3-Clause
// Event log on stderr, one line per event: simulation time, node, event, key=value. Nodes log, libraries do
// not.
//
// Text from other processes (a channel, a name) is made printable, so that it cannot control the terminal.
// Use info for events that a person who watches a run wants to see, debug for detail per packet, and a
// counter in STATUS for frequent events.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "core/sim_time.h"

namespace halocline::bus {

enum class LogLevel { kDebug, kInfo, kWarning, kError, kSilent };

// Sets the level of the whole process; the default is kInfo.
void set_log_level(LogLevel level);
// Accepts "debug", "info", "warning", "error" and "silent"; throws InvalidArgument that lists them otherwise.
LogLevel log_level_from_name(std::string_view name);

// True when the `count`-th event of a kind (1 and up) is to be reported: the 1st, the 10th, the 100th, ... A
// flood of events cannot fill a disk then.
bool worth_a_report(std::int64_t count);

// Event log of one node. Not thread-safe.
class EventLog {
 public:
  explicit EventLog(std::string node_name) : node_name_(std::move(node_name)) {}
  void set_time(SimTime now) { now_ = now; }

  // `details` is "key=value key=value ...", empty if the name of the event suffices.
  void debug(std::string_view event, std::string_view details = "") const;
  void info(std::string_view event, std::string_view details = "") const;
  void warning(std::string_view event, std::string_view details = "") const;
  void error(std::string_view event, std::string_view details = "") const;

 private:
  std::string node_name_;
  SimTime now_;
};

}  // namespace halocline::bus
