// SPDX-License-Identifier: BSD-3-Clause
// A node as a participant of lockstep in a process of its own: the protocol of lockstep_participant.h on LCM.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "bus/runtime/node.h"
#include "bus/runtime/scenario.h"

namespace halocline::bus {

// What all participants of a run must agree upon (bus/lockstep/agreement.h): of the scenario the common part,
// with seed and vehicles.
std::string agreement_on(const Scenario& scenario);

// A number for an incarnation of a participant or for a run: greater than all before (wall clock,
// microseconds), and in all likelihood unique.
std::int64_t draw_incarnation();

// Runs until the conductor's notice that the run is over. `sync_url`: grants are received there, from hosts
// that the scenario accepts; answers go to the next port.
// Once `should_stop` returns true, the node requests its last turn and waits for it 0.8 s. Throws what the
// node throws, and std::runtime_error when the conductor expels it: then it should be restarted.
void run_lockstep_participant(Node& node, const std::string& sync_url, const Scenario& scenario,
                              const std::function<bool()>& should_stop);

}  // namespace halocline::bus
