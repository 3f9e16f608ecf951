// SPDX-License-Identifier: BSD-3-Clause
// Runs nodes in lockstep in this process into a log, as fast as they compute or paced by the wall clock.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bus/logs/log_parts.h"
#include "bus/runtime/node.h"
#include "core/sim_time.h"

namespace halocline::clients {

struct EmbeddedRun {
  SimTime end;           // the run goes from 0 to here, both included
  std::string log_path;  // replaced
  bus::LogRotation rotation = {};
  double rate = 0;              // simulated seconds per wall second; 0: as fast as it computes
  int threads = 1;              // that step nodes of one stage, 1..1024; the log is the same
  std::string mirror_url = {};  // where everything is shown as well (a udpm URL); empty: nowhere
  bool quiet = false;           // no progress line
  // Called before each instant; true ends the run there.
  std::function<bool()> should_stop = [] { return false; };
};

struct RunOutcome {
  SimTime reached;
  double wall_s = 0;
  bool interrupted = false;
};

// The log holds simulation time as its stamps; it is sound and closed when this returns or throws.
RunOutcome run_embedded(const std::vector<bus::Node*>& nodes, const EmbeddedRun& run);

}  // namespace halocline::clients
