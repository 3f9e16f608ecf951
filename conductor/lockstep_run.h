// SPDX-License-Identifier: BSD-3-Clause
// Coordinates a lockstep run over udpm: runs the conductor (lockstep_conductor.h) on LCM, with its journal
// and log on disk, and mirrors the messages of the run on the ordinary bus.
#pragma once

#include <functional>
#include <set>
#include <string>

#include "bus/bus.h"
#include "bus/config/scenario.h"
#include "bus/transport/node_identity.h"
#include "core/sim_time.h"

namespace halocline::conductor {

struct LockstepRun {
  std::set<std::string> expected;  // participants that must have joined before time advances
  std::string log_path;            // replaced; empty: no log
  std::string journal_path;        // continued if it exists; empty: the run ends with its conductor
  double rate = 0;                 // simulated seconds per wall second; 0: as fast as the participants step
  SimDuration drop_after;          // silence after which a participant is dropped; 0: never
  bool lookahead = true;           // a participant that steps alone may run ahead
  bool bridge_bus = false;         // messages of others on the ordinary bus are delivered at the next instant
  std::string sync_url, bus_url;
};

// Returns when the run is over. `bus_lcm` is the ordinary bus, used with best effort. Once `should_stop`
// returns true, all participants take their last turn at the instant reached. If they do not within 0.8 s,
// the process ends, and the run can be continued from the journal. The log of a journal whose run is over is
// written again. Throws InvalidArgument for files that cannot be written.
void run_lockstep(lcm::LCM& bus_lcm, const bus::NodeIdentity& identity, const bus::Scenario& scenario,
                  const LockstepRun& run, const std::function<bool()>& should_stop);

}  // namespace halocline::conductor
