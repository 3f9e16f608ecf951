// A run in lockstep over udpm, led by this process: the conductor of lockstep_conductor.h on LCM, its journal and its
// log on disk, and the run shown on the ordinary bus.
#pragma once

#include <functional>
#include <set>
#include <string>

#include "bus/bus.h"
#include "bus/runtime/scenario.h"

namespace halocline::conductor {

struct LockstepRun {
  std::set<std::string> expected;  // participants that must have joined before time goes on
  std::string log_path;            // replaced; empty: no log
  std::string journal_path;        // gone on with where it exists; empty: a conductor that dies ends the run
  double rate = 0;                 // simulated seconds per wall second; 0: as fast as the participants follow
  SimDuration drop_after;          // silence after which a participant is dropped; 0: it is waited for
  bool windows = true;             // participants may go on alone as far as causality allows
  bool hear_outside = false;       // what others say on the ordinary bus is heard at the next instant
  std::string sync_url;
};

// Returns when the run is over. `bus_lcm`: where all that is said is shown, best effort. When `should_stop`
// first says so, everybody is asked for a farewell at the instant reached; who does not give it within a few
// seconds is not waited for, and the journal keeps the run open. Throws InvalidArgument for what cannot be
// written or is over already.
void run_lockstep(lcm::LCM& bus_lcm, const bus::NodeIdentity& identity, const bus::Scenario& scenario,
                  const LockstepRun& run, const std::function<bool()>& should_stop);

}  // namespace halocline::conductor
