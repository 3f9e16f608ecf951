// SPDX-License-Identifier: BSD-3-Clause
// What SET_ENVIRONMENT takes to make one water of another. Pure.
#pragma once

#include <optional>

#include "bus/messages.h"

namespace halocline::monitor {

// Empty where they are alike in all that SET_ENVIRONMENT sets. It holds from its reception.
std::optional<environment_change_t> change_between(const environment_t& before, const environment_t& after);

}  // namespace halocline::monitor
