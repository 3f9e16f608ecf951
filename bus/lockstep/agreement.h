// SPDX-License-Identifier: BSD-3-Clause
// Agreement of the participants of a lockstep run, as a text "scenario=... version=... messages=...
// arithmetic=...": they must have the same scenario, the same version of the program, the same message
// layouts, and the same results of the same formulas (bus/lockstep/arithmetic_digest.h). It is not a digest
// of the binary, so builds by different compilers can take part in one run.
#pragma once

#include <string>
#include <string_view>

namespace halocline::bus {

// Returns the text for lockstep_join_t::scenario_digest. `scenario` is the digest of the scenario.
std::string agreement_on(std::string_view scenario);

// Describes the items in which `theirs` differs from `ours`; empty if they agree.
std::string disagreement(std::string_view theirs, std::string_view ours);

}  // namespace halocline::bus
