// SPDX-License-Identifier: BSD-3-Clause
// Runs nodes in lockstep within this process into a log, as fast as they compute or paced by the wall clock.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bus/logs/log_parts.h"
#include "bus/runtime/node.h"
#include "core/sim_time.h"

namespace halocline::clients {

struct EmbeddedRun {
  SimTime end;           // the run covers 0 to `end`, both included
  std::string log_path;  // an existing file is replaced
  bus::LogRotation rotation = {};
  double rate = 0;  // simulated seconds per wall second; 0: as fast as it computes
  int threads = 1;  // threads that step nodes of one stage, 1..1024; the log does not depend on it
  std::string mirror_url = {};  // udpm URL to which all messages are published as well; empty: none
  bool quiet = false;           // no progress line
  // Called before each instant; the run ends there when it returns true.
  std::function<bool()> should_stop = [] { return false; };
};

// Result of an embedded run: the simulation time reached and the wall time taken.
struct RunOutcome {
  SimTime reached;
  double wall_s = 0;
  bool interrupted = false;
};

// Runs the nodes. Events of the log are stamped with simulation time. The log is complete and closed when
// this returns or throws.
RunOutcome run_embedded(const std::vector<bus::Node*>& nodes, const EmbeddedRun& run);

}  // namespace halocline::clients
