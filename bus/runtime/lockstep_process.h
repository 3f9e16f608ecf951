// SPDX-License-Identifier: BSD-3-Clause
// Runs a node as a lockstep participant in a separate process: the protocol of lockstep_participant.h on LCM.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "bus/config/scenario.h"
#include "bus/runtime/node.h"

namespace halocline::bus {

// Returns the digest on which all participants of a run must agree (bus/lockstep/agreement.h): that of the
// common part of the scenario, with seed and vehicles.
std::string agreement_on(const Scenario& scenario);

// Returns a number for an incarnation of a participant or for a run: greater than all earlier ones (wall
// clock, microseconds), and very likely unique.
std::int64_t draw_incarnation();

// Runs until the conductor reports the end of the run. Grants are received on `sync_url`, from hosts that the
// scenario accepts; answers are sent on the next port. Once `should_stop` returns true, the node requests its
// last turn and waits for it for 0.8 s. Throws what the node throws, and std::runtime_error when the
// conductor expels the node, which should then be restarted.
void run_lockstep_participant(Node& node, const std::string& sync_url, const Scenario& scenario,
                              const std::function<bool()>& should_stop);

}  // namespace halocline::bus
