// SPDX-License-Identifier: BSD-3-Clause
// One line on stderr per event: simulation time, node, event, key=value. Nodes log, libraries do not.
//
// What a log line holds of others (a channel, a name) is made printable: nothing in it moves a terminal's
// cursor. info is for a person who watches a run; per-packet detail is debug; what happens often is a counter
// in STATUS.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "core/sim_time.h"

namespace halocline::bus {

enum class LogLevel { kDebug, kInfo, kWarning, kError, kSilent };

// For the whole process; kInfo until set.
void set_log_level(LogLevel level);
// "debug", "info", "warning", "error" or "silent"; throws InvalidArgument that lists them otherwise.
LogLevel log_level_from_name(std::string_view name);

// Whether an event that came `count` times, 1 and up, is to be reported: the 1st, the 10th, the 100th, ...: a
// flood cannot fill a disk.
bool worth_a_report(std::int64_t count);

// Event log of one node. Not to be shared between threads.
class EventLog {
 public:
  explicit EventLog(std::string node_name) : node_name_(std::move(node_name)) {}
  void set_time(SimTime now) { now_ = now; }

  // `details` is "key=value key=value ...", empty where the event's name suffices.
  void debug(std::string_view event, std::string_view details = "") const;
  void info(std::string_view event, std::string_view details = "") const;
  void warning(std::string_view event, std::string_view details = "") const;
  void error(std::string_view event, std::string_view details = "") const;

 private:
  std::string node_name_;
  SimTime now_;
};

}  // namespace halocline::bus
