// A node as a participant of lockstep in a process of its own: the protocol of lockstep_participant.h on LCM.
#pragma once

#include <functional>
#include <string>

#include <lcm/lcm-cpp.hpp>

#include "bus/runtime/node.h"
#include "bus/runtime/scenario.h"

namespace halocline::bus {

// What all participants of a run must have been started with, as one word: a sum over the shared part of the
// scenario, its seed and vehicles among it.
std::string digest_of(const Scenario& scenario);

// A number for a life of a participant or a run: greater than that of any before (by the wall clock,
// microseconds), and in all likelihood nobody else's.
std::int64_t draw_life();

// Until the conductor says that the run is over. `memq` carries the node alone; `sync_url`: where grants come
// from; answers go to the next port. When `should_stop` first says so, the node asks for its farewell and
// waits for it a few seconds. Throws what the node throws, and std::runtime_error when it is put out: then it
// should be started again.
void run_lockstep_participant(lcm::LCM& memq, Node& node, const std::string& sync_url,
                              const std::string& scenario_digest, const std::function<bool()>& should_stop);

}  // namespace halocline::bus
