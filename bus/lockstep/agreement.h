// SPDX-License-Identifier: BSD-3-Clause
// What all participants of a lockstep run must agree upon, as words "scenario=... version=... messages=...
// arithmetic=...": the same scenario, the same program, the same layouts of messages, and the same results of
// the same formulas (bus/lockstep/arithmetic_digest.h). It is no digest of the binary: builds by several
// compilers take part in one run.
#pragma once

#include <string>
#include <string_view>

namespace halocline::bus {

// For lockstep_join_t::scenario_digest. `scenario`: its digest.
std::string agreement_on(std::string_view scenario);

// What of `theirs` is not as in `ours`, for a person; empty where they agree.
std::string disagreement(std::string_view theirs, std::string_view ours);

}  // namespace halocline::bus
